// What does not move by itself: formation, obstacles, hulls, the target, and markers of any node.

import { picture } from "./picture.js";
import { labelLayer, layer, screen } from "./field.js";

const bands = layer("formation", true);
const segments = layer("formation", true);
const obstacles = layer("obstacles", true);
const hulls = layer("hulls");
const target = layer("target");
const vertices = layer("formation");
const foreign = new Map();

const line = d3.line().defined((at) => at[0] !== null && at[1] !== null);
const closed = (points) => `${line(points) ?? ""}Z`;

export function drawShapes() {
  const { changed } = picture;
  const isNew = (...parts) => changed.has("all") || parts.some((part) => changed.has(part));
  if (isNew("formation", "target") || (isNew("goals") && picture.formation?.frame === "target")) drawFormation();
  if (isNew("obstacles")) drawObstacles();
  if (isNew("hulls")) drawHulls();
  if (isNew("markers")) drawMarkers();
}

// A formation in the target's frame is drawn where that frame is: the goals tell, the target itself before there are any.
function carried() {
  if (picture.formation?.frame !== "target") return "";
  const frame = picture.goals ?? picture.target;
  if (!frame || frame.at[0] === null) return null;
  return `translate(${frame.at}) rotate(${((frame.theta ?? 0) * 180) / Math.PI})`;
}

function drawFormation() {
  const place = carried();
  const queues = place === null ? [] : (picture.formation?.queues ?? []);
  for (const group of [bands, segments, vertices]) group.attr("transform", place || null);
  bands.selectAll("path").data(queues).join("path").attr("class", "band").attr("d", (queue) => line(queue.line)).attr("stroke-width", (queue) => 2 * (queue.tolerance ?? 0));
  segments.selectAll("path").data(queues).join("path").attr("class", "segment").attr("d", (queue) => line(queue.line));
  const points = queues.flatMap((queue) => queue.vertices.filter((at) => at[0] !== null));
  vertices.selectAll("circle").data(points).join("circle").attr("class", "vertex").attr("r", 0.016).attr("cx", (at) => at[0]).attr("cy", (at) => at[1]);
  const ends = picture.target && picture.target.at[0] !== null ? [picture.target] : [];
  target.selectAll("path").data(ends).join("path").attr("class", "target").attr("d", "M.09,0H-.09M0,.09V-.09M.06,0A.06,.06 0 1 1 -.06,0A.06,.06 0 1 1 .06,0")
    .attr("transform", (at) => `translate(${at.at}) rotate(${((at.theta ?? 0) * 180) / Math.PI})`);
}

// A polygon grown by its radius is its own outline, drawn twice as thick, with round corners.
function drawObstacles() {
  obstacles.selectAll("g").data(picture.obstacles, (one) => one.id).join((enter) => {
    const group = enter.append("g").attr("class", "obstacle");
    group.append("path");
    return group;
  }).select("path").attr("d", (one) => (one.points.length > 1 ? closed(one.points) : `M${one.points[0]}h0`))
    .attr("stroke-linecap", "round").attr("stroke-width", (one) => 2 * (one.radius ?? 0));
}

function drawHulls() {
  hulls.selectAll("path").data(picture.hulls, (one) => one.id).join("path").attr("class", "hull")
    .classed("combined", (one) => one.members > 1).attr("d", (one) => grown(one.points, one.radius ?? 0));
}

// A convex polygon, counter-clockwise, grown by a radius.
function grown(points, radius) {
  if (points.some((at) => at[0] === null)) return "";
  if (points.length === 1) {
    const [x, y] = points[0];
    return `M${x - radius},${y}a${radius},${radius} 0 1 0 ${2 * radius},0a${radius},${radius} 0 1 0 ${-2 * radius},0Z`;
  }
  const path = points.map(([x, y], index) => {
    const [nextX, nextY] = points[(index + 1) % points.length];
    const length = Math.hypot(nextX - x, nextY - y) || 1;
    const [dx, dy] = [((nextY - y) / length) * radius, (-(nextX - x) / length) * radius];
    const arc = index ? `A${radius},${radius} 0 0 1 ` : "M";
    return `${arc}${x + dx},${y + dy}L${nextX + dx},${nextY + dy}`;
  });
  const first = path[0].slice(1, path[0].indexOf("L"));
  return `${path.join("")}A${radius},${radius} 0 0 1 ${first}Z`;
}

// The layers of the markers that were ever seen.
export const foreignLayers = () => [...foreign.keys()];

function drawMarkers() {
  const byLayer = d3.group(picture.markers, (shape) => shape.layer || "markers");
  for (const name of byLayer.keys()) {
    if (!foreign.has(name)) foreign.set(name, { shapes: layer(`marker:${name}`), words: labelLayer(`marker:${name}`) });
  }
  for (const [name, { shapes }] of foreign) {
    const list = (byLayer.get(name) ?? []).filter((shape) => shape.kind !== "text");
    shapes.selectAll("path").data(list).join("path").each(drawMarker);
  }
  placeWords();
}

export function placeWords() {
  for (const [name, { words }] of foreign) {
    const list = picture.markers.filter((shape) => shape.kind === "text" && (shape.layer || "markers") === name && shape.points[0][0] !== null);
    words.selectAll("text").data(list).join("text").attr("class", "name").attr("text-anchor", "middle").text((shape) => shape.text)
      .attr("transform", (shape) => `translate(${screen(shape.points[0])})`);
  }
}

function drawMarker(shape) {
  const [red, green, blue, alpha] = shape.colour;
  const paint = `rgba(${red},${green},${blue},${alpha ?? 1})`;
  const isFilled = ["box", "disc", "points", "triangles"].includes(shape.kind);
  d3.select(this).attr("d", outline(shape)).attr("fill", isFilled ? paint : "none").attr("stroke", isFilled ? "none" : paint)
    .attr("stroke-width", 1.8).attr("stroke-linejoin", "round").attr("stroke-linecap", "round");
}

function outline({ kind, points, size, theta }) {
  const places = points.filter((at) => at[0] !== null && at[1] !== null);
  const [width, height] = [size[0] || 0.02, size[1] || size[0] || 0.02];
  const disc = ([x, y], rx, ry) => `M${x - rx},${y}a${rx},${ry} 0 1 0 ${2 * rx},0a${rx},${ry} 0 1 0 ${-2 * rx},0Z`;
  switch (kind) {
    case "line": return line(points) ?? "";
    case "lines": return d3.range(0, places.length - 1, 2).map((index) => `M${places[index]}L${places[index + 1]}`).join("");
    case "arrow": return places.length < 2 ? "" : arrow(places[0], places[1]);
    case "points": return places.map((at) => disc(at, width / 2, height / 2)).join("");
    case "disc": return places.length ? disc(places[0], width / 2, height / 2) : "";
    case "triangles": return d3.range(0, places.length - 2, 3).map((index) => `M${places.slice(index, index + 3).join("L")}Z`).join("");
    default: return places.length ? rectangle(places[0], width, height, theta ?? 0) : "";
  }
}

function rectangle([x, y], width, height, theta) {
  const [cos, sin] = [Math.cos(theta), Math.sin(theta)];
  const corners = [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([i, j]) => [(i * width) / 2, (j * height) / 2]);
  return `M${corners.map(([u, v]) => [x + cos * u - sin * v, y + sin * u + cos * v]).join("L")}Z`;
}

// A shaft with an open head, at most a third of its length.
export function arrow([x0, y0], [x1, y1], head = 0.05) {
  const [dx, dy] = [x1 - x0, y1 - y0];
  const length = Math.hypot(dx, dy);
  if (length < 1e-6) return "";
  const size = Math.min(head, length / 2.5) / length;
  const wing = (side) => [x1 - size * (dx - (side * dy) / 2), y1 - size * (dy + (side * dx) / 2)];
  return `M${x0},${y0}L${x1},${y1}M${wing(1)}L${x1},${y1}L${wing(-1)}`;
}
