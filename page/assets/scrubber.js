"use strict";
/* A play button and a slider; `show(value)` is called whenever the value changes. Keys: what a slider has, and space. */
class Scrubber {
  constructor(box, { seconds, show }) {
    this.box = box;
    this.play = box.querySelector("[data-do=play]");
    this.slider = box.querySelector("input");
    this.seconds = seconds;
    this.show = show;
    this.playing = 0;
    this.slider.addEventListener("input", () => {
      this.stop();
      show(Number(this.slider.value));
    });
    this.play.addEventListener("click", () => (this.playing ? this.stop() : this.start()));
    document.addEventListener("keydown", (event) => {
      if (event.key !== " " || box.hidden || event.target.closest("button, select, a, summary, input:not([type=range])")) return;
      event.preventDefault();
      this.play.click();
    });
  }

  set(value) {
    this.slider.value = value;
    this.show(value);
  }

  start() {
    const { min, max } = this.slider;
    const begin = Number(min), length = Number(max) - begin;
    if (length === 0) return; // one frame: there is nothing to play
    let at = Number(this.slider.value) >= Number(max) ? begin : Number(this.slider.value);
    let last = performance.now();
    const run = ++Scrubber.runs;
    this.playing = run;
    this.play.textContent = "Pause";
    const step = (now) => {
      if (this.playing !== run) return;
      at += (Math.max(0, now - last) / 1000 / this.seconds()) * length;
      last = now;
      this.set(begin + (((at - begin) % length) + length) % length);
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  stop() {
    this.playing = 0;
    this.play.textContent = "Play";
  }
}
Scrubber.runs = 0;
