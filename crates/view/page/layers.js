// What is drawn: one switch a layer, with a sample of what it looks like, so that it is the legend too.

import { picture } from "./picture.js";
import { foreignLayers } from "./shapes.js";

const SAMPLES = {
  robots: ["Robots", '<circle cx="11" cy="7" r="6.5" fill="var(--wait)" stroke="none"/><path d="M16 7l-3-2.4v4.8z" fill="var(--floor)" stroke="none"/>'],
  names: ["Names, ranks", '<path d="M4 12L11 1l7 11M6.5 8h9"/>'],
  trails: ["Trails, 60 s", '<path d="M1 11C8 12 10 2 21 3" stroke="var(--wait)"/>'],
  formation: ["Formation", '<path d="M1 7h20" stroke="var(--band)" stroke-width="10"/><path d="M1 7h20" stroke="var(--segment)"/><circle cx="16" cy="7" r="3" stroke="var(--segment)" fill="var(--floor)"/>'],
  goals: ["Goal points", '<path d="M1 12L12 6" stroke="var(--wait)" stroke-dasharray="1 4"/><path d="M12 2l7 7m0-7l-7 7" stroke="var(--wait)"/>'],
  leaders: ["Follows", '<path d="M1 7h19m-6-5l6 5-6 5" stroke="var(--wait)"/>'],
  velocities: ["Velocities", '<path d="M2 12L18 3m-6 0l6 0-2 5" stroke="var(--wait)"/>'],
  forces: ["Forces", '<path d="M2 12L18 3m-6 0l6 0-2 5" stroke="var(--force)"/>'],
  zones: ["Zones", '<circle cx="11" cy="7" r="6.5" stroke="var(--wait)" stroke-dasharray="2 2.5" stroke-width="1.5"/>'],
  obstacles: ["Obstacles", '<path d="M4 2h14v10H4z" fill="var(--rock)" stroke="none"/>'],
  hulls: ["Apparent obstacles", '<path d="M3 12L6 2h10l4 10z" stroke="var(--hull)" stroke-dasharray="4 3"/>'],
  target: ["Target", '<circle cx="11" cy="7" r="4" stroke="var(--force)"/><path d="M4 7h14M11 0v14" stroke="var(--force)"/>'],
  links: ["Links", '<circle cx="5" cy="7" r="4" fill="var(--good)" stroke="none"/><circle cx="14" cy="7" r="4" fill="var(--bad)" stroke="none"/>'],
  truth: ["Ground truth", '<circle cx="11" cy="7" r="6" stroke-dasharray="2 2" stroke-width="1"/>'],
};

const panel = d3.select("#layers");
// Of what controllers draw, the picture has zones of its own; forces by their terms, sectors and fragments are for those who look closely.
const QUIET = ["velocities", ...["zones", "forces", "fragments", "sectors"].map((part) => `marker:controller/${part}`)];
// What other namespaces are called here, and their samples: the terms of a law in the colours of their arrows.
const arrow = (y, colour) => `<path d="M1 ${y}h${20 - y}" stroke="${colour}" stroke-width="1.6"/>`;
const TERMS = arrow(1, "#1a73cc") + arrow(4, "#1a994d") + arrow(7, "#d9801a") + arrow(10, "#cc3326") + arrow(13, "#666");
const FOREIGN = {
  "controller/forces": ["Forces by term", TERMS],
  "controller/sectors": ["Repulsive areas"],
};
const stored = localStorage.getItem("trench.hidden");
const hidden = new Set(stored ? JSON.parse(stored) : QUIET);

export const isShown = (name) => !hidden.has(name);

// Layers of which there is nothing to show are not offered.
function offered() {
  const absent = {
    zones: !picture.setup?.zones?.length, truth: !Object.keys(picture.truth).length, target: !picture.target, links: !Object.keys(picture.links).length,
    obstacles: !picture.obstacles.length, hulls: !picture.hulls.length, leaders: !Object.keys(picture.places).length,
  };
  const known = Object.entries(SAMPLES).filter(([name]) => !absent[name]).map(([name, [title, sample]]) => ({ name, title, sample }));
  const zigzag = '<path d="M2 12L8 3l6 7 6-8" stroke-width="1.5"/>';
  const foreign = foreignLayers().map((name) => {
    const [title, sample] = FOREIGN[name] ?? [name];
    return { name: `marker:${name}`, title, sample: sample ?? zigzag };
  });
  return [...known, ...foreign];
}

export function drawLayers(onChange) {
  panel.selectAll("label").data(offered(), (one) => one.name).join((enter) => {
    const label = enter.append("label").attr("title", (one) => one.title);
    label.append("input").attr("type", "checkbox").property("checked", (one) => isShown(one.name)).on("change", (event, one) => {
      if (event.target.checked) hidden.delete(one.name);
      else hidden.add(one.name);
      localStorage.setItem("trench.hidden", JSON.stringify([...hidden]));
      onChange();
    });
    label.append("svg").attr("class", "swatch").attr("viewBox", "0 0 22 14").html((one) => one.sample);
    label.append("span").attr("class", (one) => (one.name.startsWith("marker:") ? "foreign" : "")).text((one) => one.title);
    return label;
  });
  d3.selectAll("[data-layer]").attr("display", function () {
    return isShown(this.dataset.layer) ? null : "none";
  });
}
