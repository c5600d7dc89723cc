// The stream: one WebSocket that is asked for the next picture when the last one is drawn.

export class Connection {
  constructor(onNews, onLost) {
    this.onNews = onNews;
    this.onLost = onLost;
    this.held = false;
    this.open();
  }

  open() {
    const socket = new WebSocket(`ws://${location.host}/stream`);
    this.socket = socket;
    socket.onopen = () => this.ask();
    socket.onmessage = (message) => {
      const news = JSON.parse(message.data);
      // Hidden windows draw nothing, so they ask for nothing.
      requestAnimationFrame(() => {
        if (socket !== this.socket) return;
        this.onNews(news);
        this.onLost(false);
        this.ask();
      });
    };
    socket.onclose = () => {
      if (socket !== this.socket || this.held) return;
      this.onLost(true);
      setTimeout(() => socket === this.socket && this.open(), 1000);
    };
  }

  ask() {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send("");
  }

  // {play: true}, {seek: 12.5}, {rate: 2}: bags alone understand them.
  command(command) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(command));
  }

  // Holds the live picture: nothing is asked for until it goes on, with all that was missed.
  hold(held) {
    this.held = held;
    if (held) this.socket.close();
    else this.open();
  }
}
