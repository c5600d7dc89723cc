// The page: asks for pictures, draws them, listens to the keys.

import { Connection } from "./connection.js";
import { picture, robots, take } from "./picture.js";
import * as field from "./field.js";
import { drawAlarms, drawBar, drawPlayer, startPlayer } from "./bar.js";
import { drawCards } from "./cards.js";
import { drawLayers, isShown } from "./layers.js";
import { drawRobots, placeNames } from "./robots.js";
import { drawShapes, placeWords } from "./shapes.js";
import { startTheme } from "./theme.js";
import { drawTrails } from "./trails.js";

const one = (id) => document.getElementById(id);
const CARDS = 0.1; // s, between two drawings of the cards: nobody reads faster
let frames = 0;
let cardsDrawn = 0;

function draw() {
  const { changed } = picture;
  if (changed.has("setup") || changed.has("all")) field.resize();
  field.grow();
  drawShapes();
  drawRobots();
  drawTrails(isShown("trails"));
  drawBar();
  drawPlayer();
  if (changed.has("all") || changed.has("alarms")) drawAlarms();
  const time = performance.now() / 1000;
  if (changed.has("all") || time - cardsDrawn >= CARDS) {
    cardsDrawn = time;
    drawCards();
    drawLayers(redraw);
  }
  changed.clear();
  Object.assign(document.body.dataset, {
    frames: ++frames, robots: robots().length, run: picture.run?.state ?? "", mode: picture.setup?.mode ?? "", alarms: picture.alarms.length,
    time: picture.player?.time ?? "",
  });
}

const connection = new Connection(
  (news) => {
    take(news);
    draw();
  },
  (isLost) => (one("lost").hidden = !isLost),
);

function redraw() {
  picture.changed.add("all");
  draw();
  drawLayers(redraw);
}

function pause() {
  if (picture.setup?.mode === "bag") return connection.command({ play: !picture.player?.playing });
  connection.hold(!connection.held);
  one("pause").textContent = connection.held ? "Go on" : "Pause";
}

const changeTheme = startTheme(redraw);

function toggleLayers() {
  const panel = one("layers");
  panel.hidden = !panel.hidden;
  one("open-layers").setAttribute("aria-expanded", String(!panel.hidden));
  field.resize();
}

const seek = (seconds) => picture.player && connection.command({ seek: Math.max(0, picture.player.time + seconds) });
const KEYS = {
  " ": pause, f: field.fit, t: changeTheme, l: toggleLayers, "+": () => field.zoomBy(1.4), "-": () => field.zoomBy(1 / 1.4),
  ArrowLeft: () => seek(-2), ArrowRight: () => seek(2),
};

one("pause").addEventListener("click", pause);
one("fit").addEventListener("click", field.fit);
one("open-layers").addEventListener("click", toggleLayers);
document.addEventListener("keydown", (event) => {
  const isTyping = ["INPUT", "SELECT", "BUTTON"].includes(event.target.tagName);
  const key = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!key || event.ctrlKey || event.metaKey || (isTyping && event.key !== "f" && event.key !== "t" && event.key !== "l")) return;
  event.preventDefault();
  key();
});

startPlayer((command) => connection.command(command));
field.start(() => {
  placeNames();
  placeWords();
  drawTrails(isShown("trails"));
});
drawLayers(redraw);
drawCards();
