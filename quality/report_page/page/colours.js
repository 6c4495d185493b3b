// What the view can be coloured by: values of faces, and the colours that they have.

const words = {
  deviation: 'Deviation', edge_ratio: 'Edge ratio', min_angle_deg: 'Smallest angle', max_angle_deg: 'Largest angle',
  scaled_jacobian: 'Scaled Jacobian',
  min_dihedral_deg: 'Least dihedral angle', max_dihedral_deg: 'Largest dihedral angle',
};
const largeIsBad = new Set(['edge_ratio', 'max_dihedral_deg']);
const noStep = 65535, noSet = 65535;

const isAngle = (measure) => measure.endsWith('_deg');

// "Smallest angle 12.3°"
export const named = (measure, value, unit = '') =>
  `${words[measure] || measure} ${value}${isAngle(measure) ? '°' : measure === 'deviation' ? ` ${unit}` : ''}`;

export function longTitle({ measure, of }, unit) {
  const rest = isAngle(measure) ? ', degrees' : measure === 'deviation' ? `, ${unit}` : measure === 'edge_ratio' ? ` of ${of}` : '';
  return `${words[measure] || measure}${rest}`;
}

// What counts of an element that the measure varies on.
export const heading = (m, unit) => longTitle(m, unit) + (m.measure === 'deviation' ? ', mean of each triangle' : '');

export function colourTable(text) {
  const bytes = atob(text), table = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; ++i) {
    for (let c = 0; c < 3; ++c) table[4 * i + c] = bytes.charCodeAt(3 * i + c);
    table[4 * i + 3] = 255;
  }
  return table;
}

export const css = (table, i) => `rgb(${table[4 * i]}, ${table[4 * i + 1]}, ${table[4 * i + 2]})`;

function reversed(table) {
  const other = new Uint8Array(table.length);
  for (let i = 0; i < 256; ++i) other.set(table.subarray(4 * i, 4 * i + 4), 4 * (255 - i));
  return other;
}

function tableOf(colours) {
  const table = new Uint8Array(4 * Math.max(1, colours.length));
  colours.forEach((c, i) => table.set([...c, 255], 4 * i));
  return table;
}

// Values of the steps; what has none is NaN.
export function values(steps, { low, high, bars, steps_per_bar }) {
  const size = (high - low) / (bars * steps_per_bar);
  const list = new Float32Array(steps.length);
  for (let i = 0; i < list.length; ++i) list[i] = steps[i] === noStep ? NaN : low + (steps[i] + 0.5) * size;
  return list;
}

// What takes time is made when it is first asked for.
function once(make) {
  let made;
  return () => (made === undefined ? (made = make()) : made);
}

// Each: {name, title, low, high, table, ofFaces(), ofTetrahedra(), ofReference(), names?}; values below `low` and above `high`
// have the colours of the ends.
export function colourings(view, data, unit) {
  const diverging = colourTable(view.diverging), sequential = colourTable(view.sequential);
  const element = data['result.element'];
  const list = view.measures.map((m) => {
    const isDeviation = m.measure === 'deviation', behind = data[`${m.name}.behind`];
    const ofTetrahedra = once(() => (m.of === 'tetrahedra' && !behind ? values(data[m.name], m) : null));
    const ofFaces = once(() => {
      if (m.of !== 'tetrahedra' || behind) return values(behind || data[m.name], m);
      return new Float32Array(element.length).map((_, i) => ofTetrahedra()[element[i]]);
    });
    const ofReference = once(() => (isDeviation && data['reference.deviation'] ? values(data['reference.deviation'], m) : null));
    return {
      name: m.name, measure: m.measure, title: longTitle(m, unit), low: m.low, high: m.high,
      table: isDeviation ? diverging : largeIsBad.has(m.measure) ? sequential : reversed(sequential),
      ofFaces, ofTetrahedra, ofReference,
    };
  });
  if (view.sets.length > 0)
    list.push(categories('set', 'Named face or set', view.sets.map((s) => s.name), view.sets.map((s) => s.colour),
      Float32Array.from(data['result.set'], (s) => (s === noSet ? NaN : s))));
  list.push(categories('made_up', 'Measured or made up', ['measured', 'filled', 'enriched'],
    [view.neutral, [196, 90, 40], [62, 120, 178]], Float32Array.from(data['result.made_up'])));
  list.push(categories('plain', 'Nothing', [], [], new Float32Array(data['result.set'].length).fill(NaN)));
  return list;
}

function categories(name, title, names, colours, ofFaces) {
  return {
    name, title, low: -0.5, high: Math.max(1, names.length) - 0.5, table: tableOf(colours), names,
    ofFaces: () => ofFaces, ofTetrahedra: () => null, ofReference: () => null,
  };
}
