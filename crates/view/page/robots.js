// The robots, and what belongs to each: goal point, arrows, zones, link, name.

import { body, colour, picture, robots } from "./picture.js";
import { labelLayer, layer, screen, view } from "./field.js";
import { arrow } from "./shapes.js";

const groups = Object.fromEntries(["zones", "goals", "leaders", "velocities", "forces", "truth", "robots"].map((name) => [name, layer(name)]));
const links = layer("links");
const names = labelLayer("names");

// Of arrows: metres drawn for a m/s, for a m/s^2.
const PER_SPEED = 1.2;
const PER_FORCE = 1.2;

const degrees = (theta) => ((theta ?? 0) * 180) / Math.PI;

export function drawRobots() {
  const all = robots();
  const radius = body() / 2;
  drawBodies(all, radius);
  drawGoals(all, radius);
  drawLeaders(all, radius);
  drawArrows(all, radius);
  drawZones(all);
  drawTruth(radius);
  drawLinks(all, radius);
  placeNames();
}

function drawBodies(all, radius) {
  const group = groups.robots.selectAll("g").data(all, (robot) => robot.name).join((enter) => {
    const one = enter.append("g").attr("class", "robot");
    one.append("circle").attr("class", "body");
    one.append("path").attr("class", "nose");
    one.append("circle").attr("class", "hub");
    return one;
  });
  group.attr("data-robot", (robot) => robot.name).attr("data-status", (robot) => robot.status)
    .attr("transform", (robot) => `translate(${robot.at}) rotate(${degrees(robot.theta)})`);
  group.select(".body").attr("r", radius).attr("fill", (robot) => colour(robot.name)).attr("stroke", (robot) => colour(robot.name));
  const r = radius;
  group.select(".nose").attr("d", `M${0.86 * r},0L${0.3 * r},${0.36 * r}Q${0.48 * r},0 ${0.3 * r},${-0.36 * r}Z`);
  group.select(".hub").attr("r", 0.17 * r).attr("cx", -0.3 * r);
}

function drawGoals(all, radius) {
  const withGoal = all.map((robot) => ({ name: robot.name, at: robot.at, goal: goalOf(robot.name) })).filter((one) => one.goal);
  groups.goals.selectAll("line").data(withGoal, (one) => one.name).join("line").attr("class", "to-goal").attr("stroke", (one) => colour(one.name))
    .attr("x1", (one) => one.at[0]).attr("y1", (one) => one.at[1]).attr("x2", (one) => one.goal[0]).attr("y2", (one) => one.goal[1]);
  const s = 0.3 * radius;
  groups.goals.selectAll("path").data(withGoal, (one) => one.name).join("path").attr("class", "goal").attr("stroke", (one) => colour(one.name))
    .attr("d", `M${-s},${-s}L${s},${s}M${-s},${s}L${s},${-s}`).attr("transform", (one) => `translate(${one.goal})`);
}

function goalOf(name) {
  const at = picture.goals?.by_robot[name]?.at ?? picture.control[name]?.goal;
  return at && at[0] !== null && at[1] !== null ? at : null;
}

// From each follower's edge to its leader's.
function drawLeaders(all, radius) {
  const place = new Map(all.map((robot) => [robot.name, robot.at]));
  const pairs = all.flatMap((robot) => {
    const leader = place.get(picture.places[robot.name]?.leader);
    if (!leader) return [];
    const [dx, dy] = [leader[0] - robot.at[0], leader[1] - robot.at[1]];
    const length = Math.hypot(dx, dy);
    if (length < 2.4 * radius) return [];
    const at = (distance) => [robot.at[0] + (dx / length) * distance, robot.at[1] + (dy / length) * distance];
    return [{ name: robot.name, path: arrow(at(1.15 * radius), at(length - 1.2 * radius)) }];
  });
  groups.leaders.selectAll("path").data(pairs, (pair) => pair.name).join("path").attr("class", "leader").attr("stroke", (pair) => colour(pair.name)).attr("d", (pair) => pair.path);
}

function drawArrows(all, radius) {
  const from = (robot, vector, scale) => {
    const length = Math.hypot(...vector);
    if (!(length * scale > 0.15 * radius)) return "";
    return arrow(robot.at, [robot.at[0] + vector[0] * scale, robot.at[1] + vector[1] * scale], 0.04);
  };
  const speed = (robot) => [(robot.v ?? 0) * Math.cos(robot.theta ?? 0), (robot.v ?? 0) * Math.sin(robot.theta ?? 0)];
  groups.velocities.selectAll("path").data(all, (robot) => robot.name).join("path").attr("class", "velocity").attr("fill", "none")
    .attr("stroke", (robot) => colour(robot.name)).attr("d", (robot) => from(robot, speed(robot), PER_SPEED));
  const force = (robot) => (picture.control[robot.name]?.force ?? [0, 0]).map((value) => value ?? 0);
  groups.forces.selectAll("path").data(all, (robot) => robot.name).join("path").attr("class", "force").attr("fill", "none")
    .attr("d", (robot) => from(robot, force(robot), PER_FORCE));
}

function drawZones(all) {
  const radii = picture.setup?.zones ?? [];
  const rings = all.flatMap((robot) => radii.map((radius) => ({ key: `${robot.name}/${radius}`, robot, radius })));
  groups.zones.selectAll("circle").data(rings, (ring) => ring.key).join("circle").attr("class", "zone").attr("stroke", (ring) => colour(ring.robot.name))
    .attr("r", (ring) => ring.radius).attr("cx", (ring) => ring.robot.at[0]).attr("cy", (ring) => ring.robot.at[1]);
}

function drawTruth(radius) {
  const all = Object.entries(picture.truth).filter(([, one]) => one.at[0] !== null && one.at[1] !== null);
  groups.truth.selectAll("path").data(all, ([name]) => name).join("path").attr("class", "truth")
    .attr("d", `M${radius},0A${radius},${radius} 0 1 1 ${-radius},0A${radius},${radius} 0 1 1 ${radius},0L0,0`)
    .attr("transform", ([, one]) => `translate(${one.at}) rotate(${degrees(one.theta)})`);
}

export function linkState(name) {
  const link = picture.links[name];
  if (!link) return null;
  if (!link.up) return "down";
  return link.loss > 0.2 || link.faults.length ? "weak" : "good";
}

function drawLinks(all, radius) {
  const linked = all.filter((robot) => linkState(robot.name));
  links.selectAll("circle").data(linked, (robot) => robot.name).join("circle").attr("class", "link").attr("data-link", (robot) => linkState(robot.name))
    .attr("r", 0.2 * radius).attr("cx", (robot) => robot.at[0] + 0.74 * radius).attr("cy", (robot) => robot.at[1] + 0.74 * radius);
}

// Names stay as large as they are when the field is zoomed.
export function placeNames() {
  const { k } = view();
  const text = names.selectAll("text").data(robots(), (robot) => robot.name).join((enter) => {
    const one = enter.append("text").attr("class", "name").attr("text-anchor", "middle");
    one.append("tspan");
    one.append("tspan").attr("class", "rank");
    return one;
  });
  text.attr("transform", (robot) => {
    const [x, y] = screen(robot.at);
    return `translate(${x},${y + (k * body()) / 2 + 16})`;
  });
  text.select("tspan").text((robot) => robot.name);
  text.select(".rank").text((robot) => (picture.places[robot.name] ? ` ${picture.places[robot.name].rank}` : ""));
}
