// What is known: the parts the server told of, and the last minute of every robot.

const REACH = 60; // s
const STEP = 0.095; // s, between two samples of the history

export const picture = {
  setup: null, now: 0, team: { robots: [], stamp: 0 }, run: null, formation: null, places: {}, goals: null, control: {}, stability: {}, links: {},
  truth: {}, target: null, obstacles: [], hulls: [], emergency_stop: false, markers: [], body: null, alarms: [], player: null,
  trails: new Map(), values: new Map(), changed: new Set(),
};

const beginning = structuredClone({ ...picture, trails: null, values: null, changed: null, setup: null });

export function take(news) {
  if (news.history) {
    const { setup } = picture;
    Object.assign(picture, structuredClone(beginning), { setup, trails: new Map(), values: new Map(), changed: new Set(["all"]) });
    for (const [robot, samples] of Object.entries(news.history.trails)) picture.trails.set(robot, samples);
    for (const [robot, samples] of Object.entries(news.history.values)) picture.values.set(robot, samples);
  }
  for (const [part, value] of Object.entries(news)) {
    if (part === "history") continue;
    picture[part] = value;
    picture.changed.add(part);
  }
  if (news.team) for (const robot of news.team.robots) keep(picture.trails, robot.name, [picture.now, robot.at]);
  // The monitor tells the bound too, where there is one.
  for (const [robot, one] of Object.entries(news.stability ?? {})) keep(picture.values, robot, [picture.now, one.value, one.bound]);
  for (const [robot, law] of Object.entries(news.control ?? {})) if (!picture.stability[robot]) keep(picture.values, robot, [picture.now, law.value, null]);
}

function keep(all, robot, sample) {
  if (!all.has(robot)) all.set(robot, []);
  const samples = all.get(robot);
  const last = samples.at(-1);
  if (last && sample[0] - last[0] < STEP) return;
  samples.push(sample);
  while (samples.length && sample[0] - samples[0][0] > REACH) samples.shift();
}

// The robots in the order of their names, which gives them their colours: the one of trench plot.
export function robots() {
  const byName = (a, b) => (a.name < b.name ? -1 : a.name > b.name ? 1 : 0);
  return picture.team.robots.filter((robot) => robot.at[0] !== null && robot.at[1] !== null).sort(byName);
}

export function colour(name) {
  const names = picture.team.robots.map((robot) => robot.name).sort();
  const colours = picture.setup?.colours ?? ["#0072b2"];
  const one = colours[Math.max(0, names.indexOf(name)) % colours.length];
  // Black cannot be seen in the dark.
  const isDark = document.documentElement.dataset.theme !== "light";
  return isDark ? ({ "#000000": "#e8ecf2", "#0072b2": "#2f9be0" }[one] ?? one) : one;
}

export const body = () => picture.body ?? 0.16;
