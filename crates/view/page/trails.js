// Where the robots were: lines that fade with age, on a canvas below the robots.

import { colour, picture } from "./picture.js";
import { screen, view } from "./field.js";

const canvas = document.getElementById("trails");
const context = canvas.getContext("2d");
const STEPS = 14;
const REACH = 60; // s

export function drawTrails(isShown) {
  const { size } = view();
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = size.map((length) => Math.round(length * ratio));
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, ...size);
  if (!isShown) return;
  Object.assign(context, { lineWidth: 2.4, lineJoin: "round", lineCap: "butt" });
  for (const [robot, samples] of picture.trails) {
    context.strokeStyle = colour(robot);
    // Newer parts are drawn stronger, in steps.
    let from = 0;
    for (let step = 1; step <= STEPS; step++) {
      const until = picture.now - REACH * (1 - step / STEPS);
      let to = from;
      while (to < samples.length && samples[to][0] <= until) to++;
      if (step === STEPS) to = samples.length;
      context.globalAlpha = 0.06 + 0.74 * (step / STEPS) ** 1.6;
      stroke(samples.slice(Math.max(0, from - 1), to));
      from = to;
    }
  }
  context.globalAlpha = 1;
}

function stroke(samples) {
  context.beginPath();
  let isOpen = false;
  for (const [, at] of samples) {
    if (at[0] === null || at[1] === null) {
      isOpen = false;
      continue;
    }
    const [x, y] = screen(at);
    if (isOpen) context.lineTo(x, y);
    else context.moveTo(x, y);
    isOpen = true;
  }
  context.stroke();
}
