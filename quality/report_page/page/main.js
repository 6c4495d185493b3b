// The report's page: what its text says is there without this; this adds the view, the histograms and their links.
import { arrays, frame, json } from './data.js';
import { colourings, named } from './colours.js';
import { drawHistograms } from './plots.js';
import { Panel } from './panel.js';
import { View } from './view.js';

const get = (id) => document.getElementById(id);
const count = (n) => n.toLocaleString('en');
const areShown = (n) => `${count(n)} ${n === 1 ? 'is' : 'are'} shown`;
// Of so many digits that of a part of this size a ten-thousandth is told, however far from the origin it lies.
export const placeText = (point, size) => {
  const farthest = Math.max(size, ...point.map(Math.abs));
  return `(${point.map((x) => +x.toPrecision(5 + Math.ceil(Math.log10(farthest / size)))).join(', ')})`;
};
const number = (x) => (x === null || Number.isNaN(x) ? 'none' : String(+x.toPrecision(4)));

function dropDeadLinks() {
  for (const link of document.querySelectorAll('nav a'))
    if (!document.querySelector(link.getAttribute('href'))) link.remove();
}

function tellWhatTheViewLacks(view) {
  const lines = [];
  if (view.result.is_thinned)
    lines.push(`The view shows ${count(view.result.shown)} of the mesh's ${count(view.result.triangles)} triangles, thinned; figures, histograms and the list of the worst are of all.`);
  if (view.result.is_volume && view.result.tetrahedra_shown === 0)
    lines.push(`The ${count(view.result.tetrahedra)} tetrahedra are too many for a page: the cut shows the surface alone.`);
  if (view.result.is_curved)
    lines.push('Curved elements are drawn by their corners; figures are of the curves.');
  const deviation = view.measures.find((m) => m.measure === 'deviation');
  const without = deviation ? view.result.triangles - deviation.counts.reduce((a, b) => a + b, 0) : 0;
  if (without > 0)
    lines.push(`The deviation of ${count(without)} of ${count(view.result.triangles)} triangles is not known, and they are grey: no measured point is nearest to them.`);
  if (view.reference && view.reference.is_thinned)
    lines.push(`The reference is shown by ${count(view.reference.shown)} of its ${count(view.reference.triangles)} triangles, thinned.`);
  get('thinned').textContent = lines.join(' ');
  get('thinned').hidden = lines.length === 0;
}

class Page {
  constructor(report, description, data) {
    Object.assign(this, { report, description, data });
    this.unit = report.unit || 'model units';
    this.frame = frame(description);
    this.colourings = colourings(description, data, this.unit);
    this.view = new View(get('canvas'), description, data, this.frame);
    const both = report.compared, names = both && [both.first.input, both.second.input];
    this.panel = new Panel(this.view, this.colourings, this.frame, this.unit, Boolean(this.view.reference), names,
      report.surface ? null : 'set');  // the page that measures nothing is that of a part's faces
    this.clearBars = drawHistograms(get('histograms'), description.measures, this.unit, (m, bar, words) => this.pickBar(m, bar, words));
    this.bindButtons();
    this.bindPicking();
    get('clear').addEventListener('click', () => this.clear());
  }

  numberOf(element) {
    const numbers = this.data.element_numbers;
    return numbers ? numbers[element] : element + this.description.first_element;
  }

  clear() {
    this.clearBars();
    this.view.clearChoice();
    for (const row of document.querySelectorAll('tr.chosen')) row.classList.remove('chosen');
    this.panel.tell('Nothing is selected.');
  }

  pickBar(measure, bar, words) {
    if (bar === null) {
      this.clear();
      return;
    }
    for (const row of document.querySelectorAll('tr.chosen')) row.classList.remove('chosen');
    const steps = this.data[measure.name], inBar = (s) => s !== 65535 && Math.floor(s / measure.steps_per_bar) === bar;
    let shown;
    if (measure.of === 'triangles') {
      shown = this.view.chooseTriangles((i) => inBar(steps[i]));
    } else if (this.view.tetrahedra) {
      const elements = [];
      steps.forEach((s, i) => { if (inBar(s)) elements.push(i); });
      shown = this.view.chooseTetrahedra(elements);
    } else {
      const behind = this.data[`${measure.name}.behind`];
      shown = this.view.chooseTriangles((i) => inBar(behind[i]));
    }
    this.panel.tell(`${words}; ${areShown(shown)}.`);
  }

  showWorst(index) {
    this.clearBars();
    const element = this.report.worst_elements.elements[index], worst = this.description.worst[index];
    for (const row of document.querySelectorAll('tr[data-worst]')) row.classList.toggle('chosen', +row.dataset.worst === index);
    this.view.chooseElement(worst.corners);
    const figures = ['scaled_jacobian', 'min_angle_deg', 'min_dihedral_deg', 'max_dihedral_deg', 'max_angle_deg', 'edge_ratio']
      .filter((key) => key in element).map((key) => named(key, number(element[key])));
    this.panel.tell(`Element ${element.element}: ${figures.join('; ')}; ${element.cause}.`);
    get('canvas').dataset.element = element.element;
  }

  place(point) { return placeText(point, this.frame.diagonal); }

  // In the colours of the one that the point is of: the other's may say nothing of it.
  showFarthest(isOfReference, place) {
    this.clearBars();
    this.panel.colourBy('triangles.deviation');
    if (this.view.reference) this.panel.showPart(isOfReference ? 'both' : 'result');
    this.view.showPlace(place);
    const [own, other] = ['mesh', 'reference'].map((name, i) => (this.report.compared ? ['second mesh', 'first mesh'][i] : name));
    this.panel.tell(isOfReference
      ? `The point of the ${other} that is farthest from the ${own}: ${this.place(place)}, left; to the right what the ${own} has there.`
      : `The point of the ${own} that is farthest from the ${other}: ${this.place(place)}.`);
  }

  showSet(name) {
    const index = this.description.sets.findIndex((s) => s.name === name), set = this.data['result.set'];
    const madeUp = { FILLED: 1, ENRICHED: 2 }[name];
    const shown = madeUp
      ? this.view.chooseTriangles((i) => this.data['result.made_up'][i] === madeUp)
      : this.view.chooseTriangles((i) => set[i] === index);
    this.panel.tell(`Set ${name}, triangles: ${areShown(shown)}.`);
  }

  bindButtons() {
    document.addEventListener('click', (event) => {
      const button = event.target.closest('button.show');
      if (!button) return;
      const { show, at } = button.dataset;
      if (show === 'worst') this.showWorst(+at);
      if (show === 'set') this.showSet(at);
      if (show.startsWith('farthest')) this.showFarthest(show === 'farthest-of-reference', JSON.parse(at));
      if (show === 'place') {
        this.view.showPlace(JSON.parse(at));
        this.panel.tell(`The place ${this.place(JSON.parse(at))}.`);
      }
      const calm = window.matchMedia('(prefers-reduced-motion: reduce)').matches;
      get('viewer').scrollIntoView({ behavior: calm ? 'auto' : 'smooth' });
      get('canvas').focus({ preventScroll: true });
    });
  }

  bindPicking() {
    const canvas = get('canvas');
    let from = null;
    canvas.addEventListener('pointerdown', (e) => { from = [e.clientX, e.clientY]; });
    canvas.addEventListener('click', (e) => {
      if (!from || Math.hypot(e.clientX - from[0], e.clientY - from[1]) > 4) return;
      const box = canvas.getBoundingClientRect(), hit = this.view.pick(e.clientX - box.left, e.clientY - box.top);
      if (hit) this.describe(hit);
    });
  }

  describe({ triangle, tetrahedron }) {
    const element = tetrahedron !== undefined ? tetrahedron : this.data['result.element'][triangle];
    const figures = this.colourings
      .filter((c) => !c.names)
      .map((c) => [c.measure, tetrahedron === undefined ? c.ofFaces()[triangle] : c.ofTetrahedra() && c.ofTetrahedra()[tetrahedron]])
      .filter(([, value]) => typeof value === 'number').map(([measure, value]) => named(measure, number(value), this.unit));
    const set = tetrahedron === undefined && this.description.sets[this.data['result.set'][triangle]];
    this.panel.tell(`Element ${this.numberOf(element)}: ${figures.join('; ')}${set ? `; in ${set.name}` : ''}.`);
  }
}

async function start() {
  dropDeadLinks();
  const report = json('report'), description = json('view-data');
  document.documentElement.classList.add('scripted');
  get('viewer').hidden = false;
  try {
    const page = new Page(report, description, await arrays(description.arrays));
    tellWhatTheViewLacks(description);
    document.documentElement.dataset.ready = Math.round(performance.now());
    return page;
  } catch (error) {
    document.documentElement.classList.remove('scripted');
    get('viewer').hidden = true;
    const note = document.createElement('p');
    note.className = 'hint';
    note.textContent = `The interactive view cannot be shown here: ${error.message}.`;
    get('viewer').after(note);
    if (document.createElement('canvas').getContext('webgl2')) throw error;  // of ours, not the browser's
    return null;
  }
}

start();
