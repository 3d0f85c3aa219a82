// The live page in a notebook: in a frame of its own, so that neither changes how the other looks.
class WidgetTransport {
  waiting; number; model;

  constructor(model) {
    Object.assign(this, { model, number: 0, waiting: new Map() });
    model.on("msg:custom", (message) => this.waiting.get(message.number)?.(message));
  }

  // Of links: a notebook's page has no address, and grashof live takes any.
  get address() {
    return "http://127.0.0.1/";
  }

  async begin(wanted = {}) {
    let begun = null;
    await this.ask("begin", wanted, (line) => (begun = line));
    return begun;
  }

  ask(what, body, onLine, signal) {
    this.number += 1;
    const { number } = this;
    return new Promise((resolve, reject) => {
      this.waiting.set(number, ({ line, end }) => {
        if (!end) return onLine(JSON.parse(line));
        this.waiting.delete(number);
        resolve();
      });
      signal?.addEventListener("abort", () => {
        this.waiting.delete(number);
        this.model.send({ number, leave: true });
        reject(new DOMException("left", "AbortError"));
      });
      this.model.send({ number, what, body });
    });
  }
}

function render({ model, el }) {
  const frame = document.createElement("iframe");
  Object.assign(frame, { srcdoc: PAGE, title: "Grashof live" });
  Object.assign(frame.style, { width: "100%", height: "820px", border: "0" });
  frame.addEventListener("load", () => {
    frame.contentWindow.startLive(frame.contentDocument.body, new WidgetTransport(model));
  });
  el.append(frame);
}

export default { render };
