// The stream: one WebSocket that is asked for the next picture when the last one is drawn; what is said besides is a command.

// Two lengths, the header as JSON, the picture as JPEG, what is covered as PNG.
async function unpack(buffer) {
  const view = new DataView(buffer);
  const headerEnd = 8 + view.getUint32(0, true);
  const pictureEnd = headerEnd + view.getUint32(4, true);
  const news = JSON.parse(new TextDecoder().decode(buffer.slice(8, headerEnd)));
  const image = (from, to, type) => (to > from ? createImageBitmap(new Blob([buffer.slice(from, to)], { type })) : null);
  const parts = [image(headerEnd, pictureEnd, "image/jpeg"), image(pictureEnd, buffer.byteLength, "image/png")];
  [news.picture, news.cover] = await Promise.all(parts);
  return news;
}

export class Stream {
  constructor(onNews, onLost) {
    this.onNews = onNews;
    this.onLost = onLost;
    this.open();
  }

  open() {
    const socket = new WebSocket(`ws://${location.host}/stream`);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => this.say("");
    socket.onmessage = async (message) => {
      const news = await unpack(message.data);
      // Hidden windows draw nothing, so they ask for nothing.
      requestAnimationFrame(() => {
        this.onNews(news);
        this.onLost(false);
        this.say("");
      });
    };
    socket.onclose = () => {
      this.onLost(true);
      setTimeout(() => this.open(), 1000);
    };
  }

  say(text) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(text);
  }

  // "undo", {click: {...}}: what trench calibrate live understands.
  command(command) {
    this.say(JSON.stringify(command));
  }
}
