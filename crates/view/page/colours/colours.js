// The page of trench calibrate live: asks for pictures, draws them, says what was clicked.

import { draw, setNews, shown, startCamera } from "./camera.js";
import { choose, chosen, drawPanel, startPanel } from "./panel.js";
import { Stream } from "./stream.js";
import { startTheme } from "./theme.js";

const one = (id) => document.getElementById(id);
let isHeld = false;

const stream = new Stream(
  (news) => {
    isHeld = news.held;
    setNews(news);
    draw();
    drawPanel(news);
  },
  (isLost) => (one("lost").hidden = !isLost),
);

const hold = () => stream.command({ hold: !isHeld });
const undo = () => stream.command("undo");
const gather = () => stream.command("gather");
const changeTheme = startTheme(draw);

startCamera((u, v, shot) => stream.command({ click: { which: chosen(), u, v, shot } }));
startPanel((command) => stream.command(command));
for (const [id, action] of Object.entries({ hold, undo, gather, save: () => stream.command("save"), apply: () => stream.command("apply") })) {
  one(id).addEventListener("click", action);
}
for (const [id, layer] of [["show-cover", "cover"], ["show-discs", "discs"]]) {
  one(id).addEventListener("change", () => {
    shown[layer] = one(id).checked;
    draw();
  });
}

const KEYS = { " ": hold, u: undo, l: gather, t: changeTheme, y: () => choose("yellow"), b: () => choose("blue") };
document.addEventListener("keydown", (event) => {
  const key = KEYS[event.key.toLowerCase()];
  // Space presses the button that has the focus.
  if (!key || event.ctrlKey || event.metaKey || (event.key === " " && event.target.tagName !== "CANVAS" && event.target !== document.body)) return;
  event.preventDefault();
  key();
});
