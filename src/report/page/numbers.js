/** Numbers for people. */
report.numbers = (() => {
  const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";

  function superscript(number) {
    return number.replace("-", "⁻").replace(/\d/g, (digit) => SUPERSCRIPTS[digit]);
  }

  function minus(text) {
    return /^-[0.]*$/.test(text) ? text.slice(1) : text.replace("-", "−");
  }

  function scientific(value, digits) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    const power = `10${superscript(String(Number(exponent)))}`;
    const short = String(Number(mantissa));
    if (short === "1" || short === "-1") {
      return minus(short.slice(0, -1)) + power;
    }
    return `${minus(short)}×${power}`;
  }

  /** At most so many digits, a power of ten if it is very large or very small. */
  function format(value, digits = 4) {
    if (value === null || value === undefined || Number.isNaN(value)) {
      return "–";
    }
    if (!Number.isFinite(value)) {
      return value > 0 ? "∞" : "−∞";
    }
    const size = Math.abs(value);
    if (value === 0 || (size >= 1e-3 && size < 1e5)) {
      return minus(String(Number(value.toPrecision(digits))));
    }
    return scientific(value, digits);
  }

  /** A number with its unit. */
  function withUnit(value, unit, digits = 4) {
    const number = format(value, digits);
    return unit && number !== "–" ? `${number} ${unit}` : number;
  }

  /** Kilobytes or megabytes. */
  function bytes(count) {
    return count < 1e6
      ? `${Math.max(1, Math.round(count / 1e3))} kB`
      : `${format(count / 1e6, 3)} MB`;
  }

  /** "1 run", "2 runs". */
  function counted(count, noun) {
    const number = String(count).replace(/\B(?=(\d{3})+$)/g, "\u202f");
    return `${number} ${noun}${count === 1 ? "" : "s"}`;
  }

  function percent(share) {
    return `${format(100 * share, 2)} %`;
  }

  return { format, withUnit, bytes, counted, percent };
})();
