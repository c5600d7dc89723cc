// The panel: which colour a click teaches, what is found, the limits by hand.

const one = (id) => document.getElementById(id);
const LIMITS = ["yellow", "blue", "minimum"];
const digits = (id) => (id === "minimum" ? 0 : 3);
let which = "yellow";
let isDragged = false;

export const chosen = () => which;

export function choose(colour) {
  which = colour;
  for (const button of document.querySelectorAll("#which button")) {
    button.setAttribute("aria-checked", String(button.dataset.which === colour));
  }
}

export function startPanel(command) {
  for (const button of document.querySelectorAll("#which button")) {
    button.addEventListener("click", () => choose(button.dataset.which));
  }
  for (const id of LIMITS) {
    const slider = one(id);
    slider.addEventListener("input", () => {
      isDragged = true;
      slider.previousElementSibling.textContent = (+slider.value).toFixed(digits(id));
      command({ limits: Object.fromEntries(LIMITS.map((name) => [name, +one(name).value])) });
    });
    slider.addEventListener("change", () => (isDragged = false));
  }
}

export function drawPanel(news) {
  const count = (colour) => news.discs.filter((disc) => disc[0] === colour).length;
  const [yellow, blue] = [count(1), count(2)];
  one("note").textContent = news.gathers > 0 ? `learning from ${news.gathers} more frames` : news.note.text;
  one("note").dataset.level = news.note.level;
  one("camera").textContent = news.names.camera;
  one("rate").textContent = news.shot === 0 ? "" : news.rate > 0 ? `${news.rate.toFixed(1)} frames a second` : "no frames come";
  one("hold").textContent = news.held ? "Go on" : "Hold";
  one("yellow-count").textContent = yellow;
  one("blue-count").textContent = blue;
  one("confidence").textContent = news.discs.length ? Math.min(...news.discs.map((disc) => disc[3])).toFixed(2) : "";
  one("light").textContent = news.light.map((gain) => `× ${gain.toFixed(2)}`).join("  ");
  one("where").textContent = `Save writes ${news.names.out}; Apply gives the limits to ${news.names.localizer}.`;
  for (const button of document.querySelectorAll("#which button")) {
    button.lastElementChild.textContent = news.lessons[button.dataset.which] || "";
  }
  if (!isDragged) {
    for (const [index, id] of LIMITS.entries()) {
      one(id).value = news.limits[index];
      one(id).previousElementSibling.textContent = news.limits[index].toFixed(digits(id));
    }
  }
  Object.assign(document.body.dataset, {
    shot: news.shot, yellow, blue, note: news.note.text, level: news.note.level, held: news.held, lessons: news.lessons.yellow + news.lessons.blue,
  });
}
