// The field seen from above: metres to pixels, zoom, floor, grid, axes. World groups are in metres with y upwards.

import { picture } from "./picture.js";

const svg = d3.select("#drawing");
const under = d3.select("#field").insert("svg", "canvas").attr("id", "under").attr("aria-hidden", "true");
const floor = under.append("g").attr("class", "world").append("rect").attr("class", "floor");
const grid = under.append("g").attr("class", "grid");
const below = under.append("g").attr("class", "world");
const ticks = svg.append("g");
const units = svg.append("g");
const world = svg.append("g").attr("class", "world");
const labels = svg.append("g");
const scale = svg.append("g");

let fitted = { k: 300, x: 0, y: 0 };
let transform = d3.zoomIdentity;
let size = [1, 1];
let onMove = () => {};

const zoom = d3.zoom().scaleExtent([0.2, 40]).on("zoom", (event) => {
  transform = event.transform;
  place();
});
svg.call(zoom).on("dblclick.zoom", null);

// A layer of shapes in metres. Those below lie under the trails.
export const layer = (name, isBelow = false) => (isBelow ? below : world).append("g").attr("data-layer", name);
// A layer of writing, in pixels.
export const labelLayer = (name) => labels.append("g").attr("data-layer", name);

// Pixels a metre, and where the map's origin is.
export function view() {
  return { k: transform.k * fitted.k, x: transform.x + transform.k * fitted.x, y: transform.y + transform.k * fitted.y, size };
}

export function screen([x, y]) {
  const at = view();
  return [at.x + at.k * x, at.y - at.k * y];
}

export function start(moved) {
  onMove = moved;
  new ResizeObserver(() => resize()).observe(svg.node());
  resize();
}

export function fit() {
  resize();
  svg.transition().duration(350).call(zoom.transform, d3.zoomIdentity);
}

export function zoomBy(factor) {
  svg.transition().duration(150).call(zoom.scaleBy, factor);
}

// What the camera of the small bed sees.
const BED = [0, 0, 2.48, 1.83];
let seen = BED;

// The field's corners: as they were given, else the bed's, and as far as anything was ever seen.
const corners = () => picture.setup?.field ?? seen;

// Larger worlds show themselves by what is in them.
export function grow() {
  if (picture.setup?.field) return;
  const places = [...picture.team.robots.map((robot) => robot.at), ...[...picture.obstacles, ...picture.hulls].flatMap((one) => one.points)];
  if (picture.target) places.push(picture.target.at);
  const known = places.filter(([x, y]) => x !== null && y !== null && Math.abs(x) < 1e4 && Math.abs(y) < 1e4);
  const low = (axis) => Math.min(seen[axis], ...known.filter((at) => at[axis] < seen[axis]).map((at) => Math.floor((at[axis] - 0.2) * 5) / 5));
  const high = (axis) => Math.max(seen[2 + axis], ...known.filter((at) => at[axis] > seen[2 + axis]).map((at) => Math.ceil((at[axis] + 0.2) * 5) / 5));
  const now = [low(0), low(1), high(0), high(1)];
  if (now.every((value, index) => value === seen[index])) return;
  seen = now;
  resize();
}

// The field with a margin, and room for the player below.
export function resize() {
  const { width, height } = svg.node().getBoundingClientRect();
  size = [Math.max(width, 1), Math.max(height, 1)];
  const [x0, y0, x1, y1] = corners();
  const lower = picture.setup?.mode === "bag" ? 100 : 34;
  // The list of layers covers nothing where there is room beside it.
  const panel = document.getElementById("layers");
  const left = panel.hidden || size[0] < 800 ? 56 : panel.offsetWidth + 66;
  const room = [Math.max(size[0] - left - 56, 50), Math.max(size[1] - 34 - lower, 50)];
  const k = Math.min(room[0] / (x1 - x0), room[1] / (y1 - y0));
  fitted = { k, x: left + (room[0] - k * (x1 - x0)) / 2 - k * x0, y: 22 + (room[1] + k * (y1 - y0)) / 2 + k * y0 };
  floor.attr("x", x0).attr("y", y0).attr("width", x1 - x0).attr("height", y1 - y0);
  place();
}

function place() {
  const { k, x, y } = view();
  const matrix = `translate(${x},${y}) scale(${k},${-k})`;
  under.selectAll(".world").attr("transform", matrix);
  world.attr("transform", matrix);
  drawGrid(k, x, y);
  onMove();
}

// Lines every 0.01, 0.02, 0.05, 0.1 ... m, so that they are some 60 pixels apart.
function drawGrid(k, x, y) {
  const step = d3.tickStep(0, 60 / k, 1);
  const axes = [
    { from: -x / k, to: (size[0] - x) / k, line: (v) => [x + k * v, 0, x + k * v, size[1]] },
    { from: (y - size[1]) / k, to: y / k, line: (v) => [0, y - k * v, size[0], y - k * v] },
  ];
  const values = axes.flatMap((axis, index) => {
    const first = Math.ceil(axis.from / step);
    return d3.range(first, Math.floor(axis.to / step) + 1).map((n) => ({ key: `${index}/${n}`, n, value: n * step, axis, index }));
  });
  grid.selectAll("line").data(values, (d) => d.key).join("line").classed("strong", (d) => d.n % 5 === 0)
    .each(function ({ axis, value }) {
      const [x1, y1, x2, y2] = axis.line(value);
      d3.select(this).attr("x1", x1).attr("y1", y1).attr("x2", x2).attr("y2", y2);
    });
  const format = d3.format(`.${Math.max(0, -Math.floor(Math.log10(step) + 1e-9))}f`);
  const isBag = picture.setup?.mode === "bag";
  drawTicks(values.filter((d) => d.n % 2 === 0), k, x, y, format, isBag);
  drawScale(k, step, isBag);
}

// Numbers along the floor's lower and left edges, or the window's where those are out of sight.
function drawTicks(values, k, x, y, format, isBag) {
  const [x0, y0, x1, y1] = corners();
  const below = Math.min(Math.max(y - k * y0 + 16, 16), size[1] - (isBag ? 84 : 8));
  const left = Math.min(Math.max(x + k * x0 - 8, 34), size[0] - 8);
  const onFloor = ({ index, value }) => (index === 0 ? value >= x0 - 1e-9 && value <= x1 + 1e-9 : value >= y0 - 1e-9 && value <= y1 + 1e-9);
  ticks.selectAll("text").data(values.filter(onFloor), (d) => d.key).join("text").attr("class", "tick")
    .attr("text-anchor", (d) => (d.index === 0 ? "middle" : "end")).attr("x", (d) => (d.index === 0 ? x + k * d.value : left))
    .attr("y", (d) => (d.index === 0 ? below : y - k * d.value + 4)).text((d) => format(d.value));
  const named = [{ text: "x (m)", x: x + k * x1, y: below, anchor: "start", dx: 12 }, { text: "y (m)", x: left, y: y - k * y1, anchor: "end", dx: 0 }];
  units.selectAll("text").data(named).join("text").attr("class", "unit").attr("text-anchor", (d) => d.anchor).attr("x", (d) => d.x + d.dx).attr("y", (d) => d.y).text((d) => d.text);
}

// How long a metre, or a part of it, is.
function drawScale(k, step, isBag) {
  const length = step * 5 * k < 170 ? step * 5 : step * 2;
  const [left, bottom] = [24, size[1] - (isBag ? 84 : 18)];
  scale.selectAll("path").data([0]).join("path").attr("class", "scale").attr("d", `M${left},${bottom - 5}v5h${length * k}v-5`);
  const text = length >= 1 ? `${+length.toFixed(2)} m` : `${+(length * 100).toFixed(1)} cm`;
  scale.selectAll("text").data([0]).join("text").attr("class", "unit").attr("x", left).attr("y", bottom - 10).text(text);
}
