// One time axis for passes that hours or days lie between: each as long as it lasts, gaps short.

const GAP = 0.02;

export class PassAxis {
  /** Place passes one after the other; each has a `label` and growing `time_s`. */
  constructor(passes) {
    const lengths = passes.map((pass) => pass.time_s.at(-1) - pass.time_s[0]);
    const gap = GAP * lengths.reduce((sum, length) => sum + length, 0);
    let start = 0;
    this.spans = passes.map((pass, index) => {
      const span = { pass, start, stop: start + lengths[index] };
      start = span.stop + gap;
      return span;
    });
    this.length = this.spans.at(-1)?.stop ?? 0;
    this.gap = gap;
  }

  /** Where a time of a pass lies on the axis. */
  place(span, time) {
    return span.start + time - span.pass.time_s[0];
  }

  /** Which pass a place belongs to, and what time it is there; the nearest pass in a gap. */
  at(place) {
    const away = (span) => Math.max(span.start - place, place - span.stop, 0);
    const span = this.spans.reduce((best, each) => (away(each) < away(best) ? each : best));
    const within = Math.min(Math.max(place, span.start), span.stop);
    return { pass: span.pass, time: within - span.start + span.pass.time_s[0] };
  }

  /** Where frames lie: by the name of their pass and their time; null for those of no pass. */
  frames(times, labels) {
    return times.map((time, index) => {
      const span = this.spans.find((each) => each.pass.label === labels[index]);
      return span === undefined ? null : this.place(span, time);
    });
  }

  /** Number of the frame nearest to a place, from 1; null without frames on the axis. */
  nearest(place, frames) {
    /** @type {{ distance: number, number: number } | null} */
    let best = null;
    frames.forEach((at, index) => {
      const distance = at === null ? Infinity : Math.abs(at - place);
      if (distance < (best?.distance ?? Infinity)) best = { distance, number: index + 1 };
    });
    return best?.number ?? null;
  }
}
