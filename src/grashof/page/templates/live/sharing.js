// Texts to copy: a link to the chosen design, its linkage file, the problem file; and links to open.
const COPIED = { link: "The link to the design", "problem-link": "The link to the problem", linkage: "The design", problem: "The problem" };

class Sharing {
  live; commands; panel; text;

  constructor(live, commands) {
    Object.assign(this, { live, commands, panel: $("[data-shared]", live.root), text: $("[data-shared] textarea", live.root) });
    for (const button of $$("[data-copy]", live.root)) {
      button.addEventListener("click", () => this.copy(button.dataset.copy));
    }
    $("[data-close]", this.panel).addEventListener("click", () => (this.panel.hidden = true));
    $("[data-link]", live.root).addEventListener("submit", (event) => {
      event.preventDefault();
      const input = $("[name=link]", event.target);
      if (input.value.trim()) commands.open({ link: input.value });
      input.value = "";
    });
  }

  // The server writes the text, so that every digit is that of its files.
  copy(what) {
    this.commands.closeMenus();
    const { chosen, transport } = this.live;
    const of = { file: what, address: transport.address, ...(chosen === null ? {} : { key: chosen }) };
    return this.commands.ask("file", of, ({ text }) => this.show(what, text));
  }

  async show(what, text) {
    this.text.value = text;
    this.panel.hidden = false;
    const copied = await this.copied(text);
    $("output", this.panel).textContent = `${COPIED[what]} ${copied ? "is copied" : "can be copied from here"}`;
  }

  // Whether the clipboard has the text: some browsers and notebooks refuse the newer method, some the older.
  async copied(text) {
    try {
      await navigator.clipboard.writeText(text);
      return true;
    } catch {
      this.text.select();
      return document.execCommand("copy");
    }
  }
}
