// How a page asks its solvers: over HTTP, or, in a notebook, through its widget. Lines of JSON come back.
class HttpTransport {
  token; page;

  constructor(token) {
    Object.assign(this, { token, page: crypto.randomUUID() });
  }

  // Of links to this page.
  get address() {
    return `${window.location.origin}/`;
  }

  async post(path, body, signal) {
    const headers = { "Content-Type": "application/json", "Grashof-Token": this.token };
    const answer = await fetch(path, { method: "POST", headers, body: JSON.stringify(body), signal });
    if (answer.ok) return answer;
    const refused = await answer.json().catch(() => ({ lines: [`the server answers ${answer.status}`] }));
    throw new AskError(refused.lines);
  }

  async begin(wanted = {}) {
    return (await this.post("begin", wanted)).json();
  }

  // Asks for a job and calls back with each line; leaving by the signal ends the work.
  async ask(what, body, onLine, signal) {
    const answer = await this.post("ask", { ...body, what, page: this.page }, signal);
    const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = "";
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      const lines = (rest + value).split("\n");
      rest = lines.pop();
      for (const line of lines) onLine(JSON.parse(line));
    }
  }
}

class AskError extends Error {
  constructor(lines) {
    super(lines.join("\n"));
    this.lines = lines;
  }
}
