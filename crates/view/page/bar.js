// The bar above the field, the alarms on it, the player below it.

import { picture } from "./picture.js";

const one = (id) => document.getElementById(id);
const RATES = [0.25, 0.5, 1, 2, 4, 8, 16];
const SHOWN = 4;
const minutes = (seconds) => `${Math.floor(seconds / 60)}:${(seconds % 60).toFixed(1).padStart(4, "0")}`;

export function drawBar() {
  const { run, setup, formation, team, now } = picture;
  const state = picture.emergency_stop ? "emergency" : (run?.state ?? "");
  const pill = one("run");
  pill.dataset.state = state;
  pill.textContent = picture.emergency_stop ? "emergency stop" : run ? run.state : "no run state";
  const since = run?.t0 && run.state === "running" ? (team.stamp || now) - run.t0 : null;
  one("clock").textContent = since === null ? "" : `t = ${since.toFixed(1)} s`;
  one("formation").textContent = formation?.name ?? "";
  one("reason").textContent = run?.reason ?? "";
  const mode = one("mode");
  mode.dataset.live = setup?.mode === "live";
  mode.textContent = setup?.mode === "bag" ? setup.name : "Live";
  one("pause").hidden = setup?.mode === "bag";
}

// What several nodes say in the same words is one alarm: eight of them would hide half of the field.
function merged(alarms) {
  const groups = d3.groups(alarms, (alarm) => `${alarm.level}/${alarm.message}`);
  return groups.map(([, [first, ...others]]) => {
    const name = others.length > 0 ? `${first.name} and ${others.length} more` : first.name;
    return { ...first, name, key: `${first.name}/${first.level}` };
  });
}

export function drawAlarms() {
  const alarms = merged(picture.alarms);
  const hiddenCount = alarms.length - SHOWN;
  const list = alarms.slice(0, SHOWN);
  if (hiddenCount > 0) list.push({ key: "more", level: "", name: `and ${hiddenCount} more`, message: "" });
  const box = d3.select("#alarms").selectAll(".alarm").data(list, (alarm) => alarm.key).join((enter) => {
    const alarm = enter.append("div").attr("class", "alarm");
    alarm.append("b");
    alarm.append("span");
    alarm.append("p");
    return alarm;
  });
  box.attr("data-level", (alarm) => alarm.level);
  box.select("b").text((alarm) => alarm.level);
  box.select("span").text((alarm) => alarm.name);
  box.select("p").text((alarm) => alarm.message);
}

let isDragged = false;

export function startPlayer(command) {
  const slider = one("slider");
  slider.addEventListener("input", () => {
    isDragged = true;
    one("time").textContent = minutes(+slider.value);
    command({ seek: +slider.value });
  });
  slider.addEventListener("change", () => (isDragged = false));
  one("play").addEventListener("click", () => command({ play: !picture.player?.playing }));
  const rate = one("rate");
  for (const value of RATES) rate.add(new Option(`${value}×`, value));
  rate.addEventListener("change", () => command({ rate: +rate.value }));
}

export function drawPlayer() {
  const { player } = picture;
  one("player").hidden = !player;
  if (!player) return;
  const slider = one("slider");
  slider.max = player.duration;
  if (!isDragged) {
    slider.value = player.time;
    one("time").textContent = minutes(player.time);
  }
  one("duration").textContent = minutes(player.duration);
  one("play").textContent = player.playing ? "❚❚" : "▶";
  if (document.activeElement !== one("rate")) one("rate").value = player.rate;
}
