"use strict";
/* The report of `selvage verify --html`: the timeline, the table of witnesses and the 3D view follow each other. */

/* A double from C's %a. */
function hexFloat(text) {
  const [, sign, whole, fraction, exponent] = /^(-?)0x([01])\.?([0-9a-f]*)p([+-]\d+)$/.exec(text);
  return (sign ? -1 : 1) * parseInt(whole + fraction, 16) * 2 ** (Number(exponent) - 4 * fraction.length);
}

/* Which of a witness' vertices make its first and its second feature. */
const kFeatures = {
  vf: [[0], [1, 2, 3]],
  ee: [[0, 1], [2, 3]],
  overlap: [[0, 1, 2], [3, 4, 5]],
  self: [[0], [1, 2]],
};

class ReportView {
  constructor(viewer) {
    this.viewer = viewer;
    this.report = JSON.parse(document.getElementById("report").textContent);
    this.source = new SceneSource();
    this.rows = [...document.querySelectorAll("#witnesses > tbody > tr")];
    this.title = document.getElementById("witness-title");
    this.message = document.querySelector(".view .message");
    this.witness = -1;
    this.wanted = 0;
    this.timeline = new Timeline(document.getElementById("timeline"), (frame) => this.goToFrame(frame));
    this.scrub = new Scrubber(document.getElementById("scrub"), { seconds: () => 4, show: (t) => this.showTime(t) });
    this.rows.forEach((row, i) => row.querySelector("button").addEventListener("click", () => this.goToWitness(i)));
    document.querySelector("[data-do=previous]")?.addEventListener("click", () => this.step(-1));
    document.querySelector("[data-do=next]")?.addEventListener("click", () => this.step(1));
    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("input, select")) return;
      if (event.key === "n") this.step(1);
      if (event.key === "p") this.step(-1);
    });
    this.bindCommands();
    window.addEventListener("hashchange", () => this.follow());
    this.follow();
  }

  bindCommands() {
    for (const button of document.querySelectorAll("[data-copy]")) {
      button.addEventListener("click", async () => {
        await navigator.clipboard.writeText(button.dataset.copy);
        button.textContent = "Copied";
      });
    }
    const cases = document.getElementById("cases");
    if (!cases) return;
    const texts = JSON.parse(cases.textContent);
    for (const button of document.querySelectorAll("[data-case]")) {
      const { name, text } = texts[Number(button.dataset.case)];
      button.addEventListener("click", () => {
        const link = document.createElement("a");
        link.href = URL.createObjectURL(new Blob([text], { type: "text/plain" }));
        link.download = name;
        link.click();
      });
    }
  }

  /* The address names what is shown: #witness=1 (from 1, as in the table) or #frame=0. */
  follow() {
    const [, what, number] = /^#(witness|frame)=(\d+)$/.exec(location.hash) ?? [];
    if (what === "witness" && this.rows[Number(number) - 1]) return this.showWitness(Number(number) - 1);
    if (what === "frame") return this.showFrame(Number(number));
    if (this.rows.length > 0) return this.showWitness(0);
    return this.showFrame(this.source.frames.at(-1)?.frame ?? this.report.sequence.first_frame);
  }

  goTo(hash) {
    if (location.hash === hash) this.follow();
    else location.hash = hash;
  }
  goToWitness(i) {
    this.goTo("#witness=" + (i + 1));
  }
  goToFrame(frame) {
    const i = this.report.violations.findIndex((violation) => violation.frame === frame);
    if (i >= 0) this.goToWitness(i);
    else this.goTo("#frame=" + frame);
  }
  step(by) {
    const count = this.rows.length;
    if (count > 0) this.goToWitness((this.witness < 0 ? (by > 0 ? 0 : count - 1) : this.witness + by + count) % count);
  }

  async showWitness(i) {
    const violation = this.report.violations[i];
    this.select(i);
    this.timeline.select(violation.frame);
    const start = violation.bits_t0.map((point) => point.map(hexFloat));
    const end = violation.bits_t1?.map((point) => point.map(hexFloat)) ?? start;
    const features = violation.kind === "degenerate" ? [[0], [0, 1, 2]] : kFeatures[violation.event];
    this.title.textContent = `Witness ${i + 1} of ${this.rows.length}: ${this.rows[i].dataset.title}`;
    const touch = violation.t?.lower_number ?? 0;
    const scrub = this.scrub.box;
    scrub.hidden = !violation.bits_t1;
    scrub.style.setProperty("--touch", touch);
    await this.showMeshes(violation.frame, violation.bits_t1 ? violation.frame + 1 : null, () => {
      const toView = (point) => this.source.toView(point);
      this.viewer.showPair({ ends: [start.map(toView), end.map(toView)], features, touch });
      this.scrub.stop();
      this.scrub.set(touch);
      this.viewer.flyToPair();
    });
  }

  async showFrame(frame) {
    this.select(-1);
    this.timeline.select(frame);
    this.scrub.box.hidden = true;
    this.scrub.stop();
    this.title.textContent = "Frame " + frame;
    await this.showMeshes(frame, null, () => {
      this.viewer.showPair(null);
      this.viewer.overview();
    });
  }

  /* The meshes may take a while to unpack: only what was asked for last is shown. */
  async showMeshes(frame, later, show) {
    const wanted = ++this.wanted;
    if (!this.viewer) return;
    const get = (number) => (number !== null && this.source.has(number) ? this.source.mesh(number) : null);
    const [mesh, next] = await Promise.all([get(frame), get(later)]);
    if (wanted !== this.wanted) return;
    this.viewer.showMesh(mesh, next && next.surface === mesh?.surface ? next : null);
    const absent = later !== null && mesh && !next ? "The mesh at the end of this motion is not in this page; it stands still." : "";
    this.message.textContent = mesh ? absent : "The mesh of this frame is not in this page.";
    show();
    this.viewer.box.dataset.shown = location.hash;
  }

  showTime(t) {
    this.viewer?.setTime(t);
    this.scrub.box.querySelector("output").textContent = "t = " + t.toFixed(4);
  }

  select(i) {
    this.witness = i;
    this.rows.forEach((row, k) => (k === i ? row.setAttribute("aria-current", "true") : row.removeAttribute("aria-current")));
    const row = this.rows[i];
    const box = row?.closest(".scroll");
    if (box) box.scrollTop = Math.max(0, row.offsetTop - box.clientHeight / 2);
  }
}

startViewer(document.querySelector(".view")).then((viewer) => new ReportView(viewer));
