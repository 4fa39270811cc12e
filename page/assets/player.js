"use strict";
/* The page of `selvage view`: all its frames, one after another. */
class Player {
  constructor(viewer) {
    this.viewer = viewer;
    this.source = new SceneSource();
    this.labels = this.source.frames;
    this.timesCountFrames = this.labels.every((label) => label.time === label.frame);
    this.at = -1;
    this.output = document.querySelector("#scrub output");
    this.scrub = new Scrubber(document.getElementById("scrub"), { seconds: () => this.seconds(), show: (i) => this.show(Math.round(i)) });
    this.scrub.slider.max = this.labels.length - 1;
    document.addEventListener("keydown", (event) => {
      const step = { ",": -1, ".": 1 }[event.key];
      if (step) this.scrub.set(Math.max(0, Math.min(this.labels.length - 1, this.at + step)));
    });
    window.addEventListener("hashchange", () => this.follow());
    this.follow();
  }

  /* As long as the times say; where they only count frames, 24 a second. */
  seconds() {
    const length = this.labels.at(-1).time - this.labels[0].time;
    return Math.max(0.1, this.timesCountFrames ? length / 24 : length);
  }

  /* #frame=12: the last frame of the page that is not after it. */
  follow() {
    const number = Number(/^#frame=(\d+)$/.exec(location.hash)?.[1] ?? this.labels[0].frame);
    this.scrub.set(Math.max(0, this.labels.findLastIndex((label) => label.frame <= number)));
  }

  async show(i) {
    if (i === this.at) return;
    this.at = i;
    const { frame, time, name } = this.labels[i];
    this.output.textContent = `frame ${frame}` + (this.timesCountFrames ? "" : `, ${time.toFixed(3)} s`);
    this.output.title = name;
    if (!this.viewer) return;
    const mesh = await this.source.mesh(frame);
    if (i !== this.at) return;
    this.viewer.showMesh(mesh, null);
    this.viewer.box.dataset.shown = "#frame=" + frame;
  }
}

startViewer(document.querySelector(".view")).then((viewer) => {
  viewer?.overview();
  new Player(viewer);
});
