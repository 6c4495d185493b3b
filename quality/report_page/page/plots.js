// Histograms whose bars can be picked, by mouse and by keys.
import { select } from 'd3-selection';
import { scaleLinear, scaleLog } from 'd3-scale';
import { axisBottom, axisLeft } from 'd3-axis';
import { heading, longTitle } from './colours.js';

const width = 320, height = 150, left = 38, right = 6, top = 6, bottom = 22;

// Of a tick: short, whatever its size.
const short = (x) => (x !== 0 && (Math.abs(x) < 1e-3 || Math.abs(x) >= 1e5) ? x.toExponential(1) : String(+x.toPrecision(4)));

function words(measure, bar, unit) {
  const size = (measure.high - measure.low) / measure.bars;
  const number = (x) => +x.toPrecision(4);
  const from = measure.low + bar * size, to = number(from + size);
  const range = bar === 0 ? `up to ${to}` : bar === measure.bars - 1 ? `${number(from)} or more` : `${number(from)} to ${to}`;
  const of = measure.counts[bar] === 1 ? { triangles: 'triangle', tetrahedra: 'tetrahedron' }[measure.of] : measure.of;
  return `${longTitle(measure, unit)}: ${range}, ${measure.counts[bar]} ${of}`;
}

// `pick(measure, bar)`; bar is null where none is chosen any more. Returns what takes the choice away.
export function drawHistograms(box, measures, unit, pick) {
  const clear = () => select(box).selectAll('.bar').classed('chosen', false).attr('aria-pressed', 'false');
  for (const measure of measures) {
    const figure = select(box).append('div').attr('class', 'histogram');
    figure.append('h4').text(heading(measure, unit));
    const svg = figure.append('svg').attr('viewBox', `0 0 ${width} ${height}`).attr('role', 'group')
      .attr('aria-label', `Histogram of ${longTitle(measure, unit)}`).attr('data-measure', measure.name);
    const x = scaleLinear().domain([measure.low, measure.high]).range([left, width - right]);
    const most = Math.max(10, ...measure.counts);
    const y = scaleLog().domain([0.7, most]).range([height - bottom, top]);
    const decades = [...Array(1 + Math.floor(Math.log10(most))).keys()].map((i) => 10 ** i);
    svg.append('g').attr('class', 'axis').attr('transform', `translate(0,${height - bottom})`).call(axisBottom(x).ticks(6).tickFormat(short).tickSizeOuter(0));
    svg.append('g').attr('class', 'axis').attr('transform', `translate(${left},0)`)
      .call(axisLeft(y).tickValues(decades).tickFormat((d) => d.toLocaleString('en')).tickSizeOuter(0));
    addBars(svg, measure, x, y, unit, (bar, node) => {
      const was = node.classList.contains('chosen');
      clear();
      if (!was) select(node).classed('chosen', true).attr('aria-pressed', 'true');
      pick(measure, was ? null : bar, was ? '' : words(measure, bar, unit));
    });
  }
  return clear;
}

function addBars(svg, measure, x, y, unit, choose) {
  const size = (measure.high - measure.low) / measure.bars;
  const first = measure.counts.findIndex((c) => c > 0);
  const bars = svg.selectAll('.bar').data(measure.counts).enter().append('g').attr('class', 'bar')
    .attr('role', 'button').attr('aria-pressed', 'false').attr('data-bar', (_, i) => i)
    .attr('tabindex', (_, i) => (i === Math.max(first, 0) ? 0 : -1)).attr('aria-label', (_, i) => words(measure, i, unit));
  bars.append('title').text((_, i) => words(measure, i, unit));
  const place = (i) => x(measure.low + i * size), wide = x(measure.low + size) - x(measure.low);
  bars.append('rect').attr('class', 'hit').attr('x', (_, i) => place(i)).attr('y', top).attr('width', wide).attr('height', height - bottom - top);
  bars.append('rect').attr('class', 'count').attr('x', (_, i) => place(i) + 0.5).attr('width', Math.max(1, wide - 1))
    .attr('y', (c) => (c > 0 ? y(c) : height - bottom)).attr('height', (c) => (c > 0 ? height - bottom - y(c) : 0));
  const nodes = bars.nodes();
  nodes.forEach((node, i) => {
    node.addEventListener('click', () => measure.counts[i] > 0 && choose(i, node));
    node.addEventListener('keydown', (event) => {
      if (event.key === 'Enter' || event.key === ' ') {
        event.preventDefault();
        if (measure.counts[i] > 0) choose(i, node);
      }
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!step) return;
      event.preventDefault();
      let next = i + step;
      while (nodes[next] && measure.counts[next] === 0) next += step;
      if (!nodes[next]) return;
      node.setAttribute('tabindex', -1);
      nodes[next].setAttribute('tabindex', 0);
      nodes[next].focus();
    });
  });
}

// The scale of a coloring as a ramp with ticks, or its names.
export function drawLegend(box, colouring, low, high, css) {
  box.textContent = '';
  if (colouring.names) {
    colouring.names.forEach((name, i) => {
      const entry = select(box).append('span');
      entry.append('span').attr('class', 'swatch').style('background', css(i));
      entry.append('span').text(name);
    });
    return;
  }
  const wide = Math.max(300, Math.min(640, box.clientWidth || 640)), end = Math.round(0.66 * wide), svg = select(box).append('svg').attr('viewBox', `0 0 ${wide} 36`).attr('preserveAspectRatio', 'xMinYMid meet')
    .attr('role', 'img').attr('aria-label', `${colouring.title}, from ${low} to ${high}`);
  const side = 26;  // half of the widest number below an end
  const ramp = svg.append('defs').append('linearGradient').attr('id', 'ramp');
  for (let i = 0; i <= 32; ++i) ramp.append('stop').attr('offset', i / 32).attr('stop-color', css(Math.round((255 * i) / 32)));
  svg.append('rect').attr('x', side).attr('y', 2).attr('width', end - side).attr('height', 12).attr('fill', 'url(#ramp)');
  const x = scaleLinear().domain([low, high]).range([side, end]);
  svg.append('g').attr('class', 'axis').attr('transform', 'translate(0,14)').call(axisBottom(x).ticks(wide / 90).tickFormat(short).tickSizeOuter(0));
  svg.append('text').attr('x', end + 14).attr('y', 12).attr('font-size', 12).text(colouring.title);
}
