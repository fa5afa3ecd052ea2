/** Scales: from values to places on a line, and back; ticks. */
report.scales = (() => {
  const SPACINGS = {
    linear: { place: (value) => value, value: (place) => place },
    logarithmic: { place: Math.log, value: Math.exp },
  };

  /** Values at equal distances, others between them by differences. */
  function even(values) {
    const last = Math.max(0, values.length - 2);
    const below = (value) => {
      const index = values.findIndex((_, at) => at > last || value < values[at + 1]);
      return Math.min(last, Math.max(0, index));
    };
    return {
      place(value) {
        const index = below(value);
        const gap = values[index + 1] - values[index];
        return gap > 0 ? index + (value - values[index]) / gap : index;
      },
      value(place) {
        const index = Math.min(last, Math.max(0, Math.floor(place)));
        const gap = (values[index + 1] ?? values[index] + 1) - values[index];
        return values[index] + (place - index) * gap;
      },
    };
  }

  function spacing(kind, values = []) {
    return kind === "even" ? even(values) : (SPACINGS[kind] ?? SPACINGS.linear);
  }

  /** A scale from [low, high] to the places [from, to]. */
  function scale(kind, [low, high], [from, to], values) {
    const { place, value } = spacing(kind, values);
    const [start, end] = [place(low), place(high)];
    const span = end - start || 1;
    return {
      kind,
      low,
      high,
      from,
      to,
      at: (wanted) => from + ((place(wanted) - start) / span) * (to - from),
      value: (at) => value(start + ((at - from) / (to - from)) * span),
    };
  }

  /** The borders of the cells of values: halfway between them, as far beyond the first and last. */
  function edges(kind, values) {
    const { place, value } = spacing(kind, values);
    const places = values.map(place);
    if (places.length === 1) {
      return kind === "logarithmic"
        ? [values[0] / 2, values[0] * 2]
        : [
            values[0] - 0.5 * (Math.abs(values[0]) || 1),
            values[0] + 0.5 * (Math.abs(values[0]) || 1),
          ];
    }
    const last = places.length - 1;
    const between = places.slice(1).map((right, index) => 0.5 * (places[index] + right));
    const ends = [1.5 * places[0] - 0.5 * places[1], 1.5 * places[last] - 0.5 * places[last - 1]];
    return [ends[0], ...between, ends[1]].map(value);
  }

  /** Round values between two, about as many as wanted. */
  function linearTicks(low, high, wanted) {
    const raw = (high - low) / Math.max(1, wanted);
    if (!(raw > 0)) {
      return [low];
    }
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].find((factor) => factor * power >= raw * 0.999) * power;
    const first = Math.ceil(low / step - 1e-9);
    const count = Math.floor(high / step + 1e-9) - first;
    return Array.from({ length: Math.max(0, count + 1) }, (_, index) =>
      Number(((first + index) * step).toPrecision(12)),
    );
  }

  function logarithmicTicks(low, high, wanted) {
    const decades = Math.log10(high / low);
    const factors = decades * 3 <= wanted ? [1, 2, 5] : [1];
    const every = Math.max(1, Math.ceil(decades / Math.max(1, wanted)));
    const ticks = [];
    for (
      let power = Math.floor(Math.log10(low));
      power <= Math.ceil(Math.log10(high));
      power += 1
    ) {
      if (power % every === 0 || factors.length > 1) {
        ticks.push(...factors.map((factor) => Number(`${factor}e${power}`)));
      }
    }
    const inside = ticks.filter((tick) => tick >= low * 0.9999 && tick <= high * 1.0001);
    return inside.length >= 2 ? inside : linearTicks(low, high, wanted);
  }

  function ticks(scale, distance = 64) {
    const wanted = Math.max(2, Math.abs(scale.to - scale.from) / distance);
    const find = scale.kind === "logarithmic" ? logarithmicTicks : linearTicks;
    return find(scale.low, scale.high, wanted);
  }

  /** Ends of values, widened a little so that nothing lies on the frame. */
  function ends(values, kind = "linear") {
    const finite = values.filter(
      (value) => Number.isFinite(value) && (kind === "linear" || value > 0),
    );
    if (finite.length === 0) {
      return kind === "linear" ? [0, 1] : [0.1, 10];
    }
    let low = finite.reduce((one, other) => Math.min(one, other));
    let high = finite.reduce((one, other) => Math.max(one, other));
    if (kind === "logarithmic") {
      return low === high ? [low / 2, high * 2] : [low / 1.2, high * 1.2];
    }
    if (low === high) {
      [low, high] = [low - (Math.abs(low) || 1) / 2, high + (Math.abs(high) || 1) / 2];
    }
    const room = 0.04 * (high - low);
    return [low - room, high + room];
  }

  return { scale, edges, ticks, ends };
})();
