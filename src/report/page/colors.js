/** Colours of labels, of values and of lines. */
report.colors = (() => {
  /** Viridis (van der Walt and Smith, 2015; CC0). */
  const SEQUENTIAL = [
    "#440154",
    "#472d7b",
    "#3b528b",
    "#2c728e",
    "#21918c",
    "#28ae80",
    "#5ec962",
    "#addc30",
    "#fde725",
  ];
  /** RdBu, reversed (Harrower and Brewer, 2003). */
  const DIVERGING = [
    "#2166ac",
    "#4393c3",
    "#92c5de",
    "#d1e5f0",
    "#f7f7f7",
    "#fddbc7",
    "#f4a582",
    "#d6604d",
    "#b2182b",
  ];
  /** Told apart by every kind of colour vision (Okabe and Ito, 2008). */
  const DISTINCT = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
  const FALLBACK = "#8a8f94";

  /** The data's colour if it is one, so that nothing else reaches an attribute. */
  function safe(text) {
    return /^#[0-9a-f]{6}$/i.test(text) ? text : FALLBACK;
  }

  function channels(hex) {
    return [1, 3, 5].map((start) => parseInt(hex.slice(start, start + 2), 16));
  }

  /** `share` of `other` in `color`. */
  function mix(color, other, share) {
    const [from, to] = [channels(color), channels(other)];
    const mixed = from.map((channel, index) => Math.round(channel + share * (to[index] - channel)));
    return `#${mixed.map((channel) => channel.toString(16).padStart(2, "0")).join("")}`;
  }

  /** As pale as the seeds disagree. */
  function faded(color, agreement) {
    return mix(color, "#ffffff", 0.85 * (1 - agreement));
  }

  function isDark(color) {
    const [red, green, blue] = channels(color);
    return 0.299 * red + 0.587 * green + 0.114 * blue < 128;
  }

  function at(anchors, fraction) {
    const position = Math.min(1, Math.max(0, fraction)) * (anchors.length - 1);
    const index = Math.min(Math.floor(position), anchors.length - 2);
    return mix(anchors[index], anchors[index + 1], position - index);
  }

  /** The range of values and their colours; null without values. Signed ones have zero in the middle. */
  function ramp(values, isSigned) {
    const finite = values.filter(Number.isFinite);
    if (finite.length === 0) {
      return null;
    }
    let [low, high] = [Math.min(...finite), Math.max(...finite)];
    if (isSigned) {
      high = Math.max(Math.abs(low), Math.abs(high)) || 1;
      low = -high;
    }
    if (high - low <= 1e-9 * Math.max(Math.abs(low), Math.abs(high))) {
      const widening = high === 0 ? 1 : 0.5 * Math.abs(high);
      [low, high] = [low - widening, high + widening];
    }
    const anchors = isSigned ? DIVERGING : SEQUENTIAL;
    return { low, high, color: (value) => at(anchors, steps((value - low) / (high - low))) };
  }

  /** Few colours, so that equal ones are drawn together. */
  function steps(fraction) {
    return Math.round(fraction * 127) / 127;
  }

  function distinct(index) {
    return DISTINCT[index % DISTINCT.length];
  }

  return { safe, mix, faded, isDark, ramp, distinct };
})();
