"use strict";
/* Buttons, one a frame or a few frames, of which one is current; arrow keys go along them. */
class Timeline {
  constructor(list, choose) {
    this.buttons = [...list.querySelectorAll("button")];
    this.status = document.getElementById("timeline-status");
    for (const button of this.buttons) {
      button.addEventListener("click", () => choose(Number(button.dataset.frame)));
      for (const event of ["focus", "pointerenter"]) button.addEventListener(event, () => this.tell(button));
    }
    list.addEventListener("pointerleave", () => this.tell(this.current));
    list.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      const at = this.buttons.indexOf(document.activeElement);
      if (!step || at < 0) return;
      event.preventDefault();
      this.buttons[Math.max(0, Math.min(this.buttons.length - 1, at + step))].focus();
    });
  }

  tell(button) {
    if (button) this.status.textContent = button.title;
  }

  select(frame) {
    this.current?.removeAttribute("aria-current");
    this.current = this.buttons.find((button) => Number(button.dataset.begin) <= frame && frame < Number(button.dataset.end));
    this.current?.setAttribute("aria-current", "true");
    this.buttons.forEach((button) => (button.tabIndex = button === this.current ? 0 : -1));
    this.tell(this.current);
  }
}
