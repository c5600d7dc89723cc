// One card a robot: how it is, and its Lyapunov value over the last minute.

import { colour, picture, robots } from "./picture.js";
import { linkState } from "./robots.js";

const team = d3.select("#team");
const REACH = 60; // s
const STATUS = { predicted: "not seen", lost: "lost", ambiguous: "in doubt" };
const LINK = { weak: "weak link", down: "no link" };

const DECADES = 5;

const length = (metres) => (metres === null || metres === undefined ? "–" : metres < 0.01 ? `${(metres * 1000).toFixed(1)}<small> mm</small>` : metres < 1 ? `${(metres * 100).toFixed(1)}<small> cm</small>` : `${metres.toFixed(2)}<small> m</small>`);
const speed = (v) => (v === null || v === undefined ? "–" : `${(Math.abs(v) < 0.0005 ? 0 : v).toFixed(3)}<small> m/s</small>`);
const energy = (value) => (value === null || value === undefined ? "–" : value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e4) ? value.toExponential(1) : d3.format(".3~r")(value));

export function drawCards() {
  const all = robots();
  team.selectAll(".empty").data(all.length ? [] : [0]).join("div").attr("class", "empty")
    .text(picture.setup?.mode === "bag" ? "No robots yet at this time." : "No robots yet: waiting for /team_state.");
  const card = team.selectAll(".card").data(all, (robot) => robot.name).join((enter) => {
    const one = enter.append("article").attr("class", "card");
    one.append("header").html('<span class="dot"></span><span class="who"></span><span class="tags"></span>');
    one.append("dl").html("<div><dt>to goal</dt><dd></dd></div><div><dt>speed</dt><dd></dd></div><div><dt>V</dt><dd></dd></div>");
    one.append("canvas");
    return one;
  });
  card.attr("data-robot", (robot) => robot.name);
  card.select(".dot").style("background", (robot) => colour(robot.name));
  card.select(".who").text((robot) => robot.name);
  card.select(".tags").selectAll("span").data(tags, (tag) => tag.text).join("span").attr("class", (tag) => `tag ${tag.kind}`)
    .attr("title", (tag) => tag.title ?? null).text((tag) => tag.text);
  card.each(function (robot) {
    const law = picture.control[robot.name];
    const monitor = picture.stability[robot.name];
    const values = [length(law?.goal_distance), speed(robot.v), energy(monitor?.value ?? law?.value)];
    this.title = monitor ? monitor.violation || `law ${monitor.law}, ${monitor.equation}: V is within its bound ${energy(monitor.bound)}, to which ${monitor.term} adds most` : "";
    d3.select(this).selectAll("dd").data(values).html((value) => value);
    drawChart(this.querySelector("canvas"), robot.name);
  });
}

// The number of the condition that does not hold: the monitor says robot, equation and what is wrong, with colons between.
const violated = (monitor) => monitor.violation.split(": ")[1] || monitor.equation;

function tags(robot) {
  const place = picture.places[robot.name];
  const law = picture.control[robot.name];
  const list = [];
  if (STATUS[robot.status]) list.push({ text: STATUS[robot.status], kind: "bad" });
  const monitor = picture.stability[robot.name];
  if (monitor?.holds === false) list.push({ text: `violates ${violated(monitor)}`, title: monitor.violation, kind: "bad" });
  const link = LINK[linkState(robot.name)];
  if (link) list.push({ text: link, kind: "bad" });
  for (const limit of law?.limits ?? []) list.push({ text: limit, kind: ["stale", "deviates"].includes(limit) ? "bad" : "" });
  if (law?.conforms) list.push({ text: "conforms", kind: "good" });
  if (place) list.push({ text: place.leader ? `${place.rank} · follows ${place.leader}` : `${place.rank} · leads`, kind: "" });
  return list;
}

// V as a filled line, what it may be at most dashed above it; in decades, for it falls exponentially.
function drawChart(canvas, robot) {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (!width) return;
  if (canvas.width !== Math.round(width * ratio)) Object.assign(canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  const samples = picture.values.get(robot) ?? [];
  const style = getComputedStyle(document.documentElement);
  context.strokeStyle = style.getPropertyValue("--edge");
  context.lineWidth = 1;
  context.strokeRect(0.5, height - 0.5, width - 1, 0);
  const high = d3.max(samples, (sample) => Math.max(sample[1] ?? 0, sample[2] ?? 0)) || 1;
  const x = d3.scaleLinear([picture.now - REACH, picture.now], [0, width]);
  const least = high * 10 ** -DECADES;
  const decades = d3.scaleLog([least, high], [height - 1, 14]);
  const y = (value) => decades(Math.max(value, least));
  const known = (index) => (sample) => sample[index] !== null && sample[index] !== undefined;
  const line = (index) => d3.line((sample) => x(sample[0]), (sample) => y(sample[index])).defined(known(index)).context(context);
  const paint = colour(robot);
  context.fillStyle = paint;
  context.globalAlpha = 0.16;
  context.beginPath();
  d3.area((sample) => x(sample[0]), height - 1, (sample) => y(sample[1])).defined(known(1)).context(context)(samples);
  context.fill();
  context.globalAlpha = 1;
  Object.assign(context, { strokeStyle: paint, lineWidth: 1.7, lineJoin: "round" });
  context.beginPath();
  line(1)(samples);
  context.stroke();
  Object.assign(context, { strokeStyle: style.getPropertyValue("--warn"), lineWidth: 1.2 });
  context.setLineDash([4, 3]);
  context.beginPath();
  line(2)(samples);
  context.stroke();
  context.setLineDash([]);
  Object.assign(context, { fillStyle: style.getPropertyValue("--quiet"), font: "10.5px Inter, sans-serif", textAlign: "left" });
  context.fillText(samples.length ? `V${samples.at(-1)[2] === null || samples.at(-1)[2] === undefined ? "" : " and its bound"}, top ${energy(high)}, ${DECADES} decades` : "", 0, 9);
  context.textAlign = "right";
  context.fillText("last 60 s", width, 9);
}
