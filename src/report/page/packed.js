/** Columns that are packed: bytes, compressed with zlib, in base64. */
report.packed = (() => {
  /** The bytes of a packed text. */
  async function bytes(text) {
    const compressed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  /** Codes of `width` bytes from their planes, low bytes first, each the difference to the one before. */
  function codes(plane, width, count) {
    const modulus = 256 ** width;
    const found = new Uint16Array(count);
    let last = 0;
    for (let index = 0; index < count; index += 1) {
      const step = plane[index] + (width === 2 ? 256 * plane[count + index] : 0);
      last = (last + step) % modulus;
      found[index] = last;
    }
    return found;
  }

  /** Values between two ends from codes; the largest code stands for no value. */
  function values(found, width, low, high) {
    const none = 256 ** width - 1;
    return Float64Array.from(found, (code) =>
      code === none ? NaN : low + ((high - low) * code) / (none - 1),
    );
  }

  const unpacked = new Map();

  /** The bytes of a packed object, unpacked once. */
  function once(object) {
    if (!unpacked.has(object)) {
      unpacked.set(object, bytes(object.data));
    }
    return unpacked.get(object);
  }

  /** The columns over time of one run: {time, columns: [values]}; null if it has none. */
  async function seriesOf(series, run) {
    const place = series.runs ? series.runs.indexOf(run) : run;
    if (place < 0 || place >= series.times.length) {
      return null;
    }
    const all = await once(series);
    const { points, width } = series;
    const size = points * width;
    const columns = series.columns.map((_, index) => {
      const cell = place * series.columns.length + index;
      const plane = all.subarray(cell * size, (cell + 1) * size);
      const [low, high] = [series.ranges[2 * cell], series.ranges[2 * cell + 1]];
      return values(codes(plane, width, points), width, low, high);
    });
    const [from, to] = series.times[place];
    const time = Float64Array.from(
      { length: points },
      (_, index) => from + ((to - from) * index) / Math.max(1, points - 1),
    );
    return { time, columns, frames: series.frames?.[place] ?? null };
  }

  /** The positions of an animation: at(frame, sphere) is [x, y, z], or null for one that is not in. */
  async function statesOf(states) {
    const all = await once(states);
    const { count, low, high } = states;
    const planes = states.times.map((_, frame) =>
      [0, 1, 2].map((axis) => {
        const start = 2 * count * (3 * frame + axis);
        const plane = all.subarray(start, start + 2 * count);
        return values(codes(plane, 2, count), 2, low[axis], high[axis]);
      }),
    );
    return (frame, sphere) => {
      const place = planes[frame].map((axis) => axis[sphere]);
      return place.every(Number.isFinite) ? place : null;
    };
  }

  return { seriesOf, statesOf };
})();
