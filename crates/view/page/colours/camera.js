// The camera's picture with what is covered on it, and the loupe at the pointer.

const canvas = document.getElementById("picture");
const loupe = document.getElementById("loupe");
const RINGS = ["", "#ff00aa", "#00ff8c"]; // around yellow and blue discs
const TIMES = 6; // what the loupe magnifies
const OPACITY = 0.6;

let news = null;
let pointer = null; // column and row
let fit = { scale: 1, x: 0, y: 0 };
export const shown = { cover: true, discs: true };

export function setNews(next) {
  // The picture that was drawn before is not needed any more.
  news?.picture?.close();
  news?.cover?.close();
  news = next;
}

// The pixel below a place of the window; null outside the picture.
function pixelAt(event) {
  if (!news?.picture) return null;
  const box = canvas.getBoundingClientRect();
  const u = (event.clientX - box.left - fit.x) / fit.scale - 0.5;
  const v = (event.clientY - box.top - fit.y) / fit.scale - 0.5;
  return u > -0.5 && v > -0.5 && u < news.size[0] - 0.5 && v < news.size[1] - 0.5 ? [u, v] : null;
}

function drawIn(context, { scale, x, y }) {
  const [width, height] = news.size;
  const box = [x, y, width * scale, height * scale];
  context.drawImage(news.picture, ...box);
  if (shown.cover && news.cover) {
    context.globalAlpha = OPACITY;
    context.drawImage(news.cover, ...box);
    context.globalAlpha = 1;
  }
  if (!shown.discs) return;
  context.lineWidth = 2;
  for (const [colour, u, v, confidence] of news.discs) {
    context.strokeStyle = RINGS[colour];
    context.setLineDash(confidence > 0.8 ? [] : [4, 3]);
    context.beginPath();
    context.ellipse(x + (u + 0.5) * scale, y + (v + 0.5) * scale, news.half[0] * scale + 3, news.half[1] * scale + 3, 0, 0, 2 * Math.PI);
    context.stroke();
  }
  context.setLineDash([]);
}

function drawLoupe() {
  const context = loupe.getContext("2d");
  context.clearRect(0, 0, loupe.width, loupe.height);
  const middle = [loupe.width / 2, loupe.height / 2];
  if (!pointer || !news?.picture) {
    context.fillStyle = getComputedStyle(loupe).color;
    context.globalAlpha = 0.6;
    context.font = "12px Inter, sans-serif";
    context.textAlign = "center";
    context.fillText("point at the picture to look closely", ...middle);
    context.globalAlpha = 1;
    return;
  }
  context.imageSmoothingEnabled = false;
  drawIn(context, { scale: TIMES, x: middle[0] - (pointer[0] + 0.5) * TIMES, y: middle[1] - (pointer[1] + 0.5) * TIMES });
  context.strokeStyle = "#ffffff";
  context.lineWidth = 1;
  context.strokeRect(middle[0] - TIMES / 2, middle[1] - TIMES / 2, TIMES, TIMES);
}

export function draw() {
  const box = canvas.getBoundingClientRect();
  const ratio = devicePixelRatio;
  const size = [Math.round(box.width * ratio), Math.round(box.height * ratio)];
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, box.width, box.height);
  drawLoupe();
  if (!news?.picture) return;
  const scale = Math.min((box.width - 24) / news.size[0], (box.height - 24) / news.size[1]);
  fit = { scale, x: (box.width - news.size[0] * scale) / 2, y: (box.height - news.size[1] * scale) / 2 };
  context.imageSmoothingEnabled = scale < 2;
  drawIn(context, fit);
}

// Calls `onClick(column, row, shot)` for clicks into the picture.
export function startCamera(onClick) {
  canvas.addEventListener("pointermove", (event) => {
    pointer = pixelAt(event);
    drawLoupe();
  });
  canvas.addEventListener("pointerleave", () => {
    pointer = null;
    drawLoupe();
  });
  canvas.addEventListener("click", (event) => {
    const pixel = pixelAt(event);
    if (pixel) onClick(...pixel, news.shot);
  });
  new ResizeObserver(draw).observe(canvas);
}
