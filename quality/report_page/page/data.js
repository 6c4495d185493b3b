// Reads what the page carries: see packed_arrays.hpp and view_data.cpp.

export const json = (id) => JSON.parse(document.getElementById(id).textContent);

async function expanded(text) {
  const characters = atob(text), packed = new Uint8Array(characters.length);
  for (let i = 0; i < packed.length; ++i) packed[i] = characters.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function array(bytes, { kind, at, count, per_element }) {
  if (kind === 'u8') return bytes.subarray(at, at + count);
  const values = kind === 'u16' ? new Uint16Array(count) : new Uint32Array(count);
  const planes = values.BYTES_PER_ELEMENT;
  for (let p = 0; p < planes; ++p)
    for (let i = 0, from = at + p * count; i < count; ++i) values[i] |= bytes[from + i] << (8 * p);
  if (kind !== 'indices') return values;
  for (let i = 0; i < count; ++i) {
    const difference = (values[i] >>> 1) ^ -(values[i] & 1);
    values[i] = difference + (i >= per_element ? values[i - per_element] : 0);
  }
  return values;
}

// {name: typed array}
export async function arrays(directory) {
  const bytes = await expanded(document.getElementById('arrays').textContent);
  return Object.fromEntries(Object.entries(directory).map(([name, entry]) => [name, array(bytes, entry)]));
}

// Places in the scene: the box's middle at 0, its diagonal 1.
export function frame({ low, high }) {
  const size = low.map((l, k) => high[k] - l);
  const diagonal = Math.hypot(...size) || 1;
  const middle = low.map((l, k) => (l + high[k]) / 2);
  return {
    size, diagonal, low, high,
    toScene: (p) => p.map((x, k) => (x - middle[k]) / diagonal),
    toModel: (x, k) => x * diagonal + middle[k],
    // x of all points, then y, then z, in 65535ths of the box.
    points(steps) {
      const n = steps.length / 3, points = new Float32Array(3 * n);
      for (let k = 0; k < 3; ++k) {
        const start = (low[k] - middle[k]) / diagonal, step = size[k] / diagonal / 65535;
        for (let i = 0; i < n; ++i) points[3 * i + k] = start + step * steps[k * n + i];
      }
      return points;
    },
  };
}
