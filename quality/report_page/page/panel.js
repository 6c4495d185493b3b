// The controls beside the view, and the keys of the view.
import { css } from './colours.js';
import { drawLegend } from './plots.js';

const get = (id) => document.getElementById(id);

export class Panel {
  constructor(view, colourings, frame, unit, hasReference, names, first) {
    Object.assign(this, { view, colourings, frame, unit });
    this.tell = (text) => { get('picked').textContent = text; };
    this.fillColours(first);
    this.bindParts(hasReference, names);
    this.bindCut();
    get('edges').checked = view.withEdges;
    get('edges').addEventListener('change', (e) => view.edges(e.target.checked));
    for (const button of document.querySelectorAll('[data-look]'))
      button.addEventListener('click', () => view.look(button.dataset.look));
    get('panel').addEventListener('submit', (e) => e.preventDefault());
    this.bindKeys();
  }

  fillColours(first) {
    const box = get('colour');
    for (const c of this.colourings) box.add(new Option(c.title, c.name));
    box.addEventListener('change', () => this.colourBy(box.value));
    for (const id of ['scale-low', 'scale-high']) get(id).addEventListener('change', () => this.rescale());
    get('scale-reset').addEventListener('click', () => this.colourBy(box.value));
    this.colourBy((this.colourings.find((c) => c.name === first) || this.colourings[0]).name);
  }

  colourBy(name) {
    this.colouring = this.colourings.find((c) => c.name === name);
    get('colour').value = name;
    const { low, high, names } = this.colouring;
    for (const id of ['scale-low', 'scale-high', 'scale-reset']) get(id).disabled = Boolean(names);
    get('scale-low').value = names ? '' : +low.toPrecision(6);
    get('scale-high').value = names ? '' : +high.toPrecision(6);
    for (const id of ['scale-low', 'scale-high']) get(id).setCustomValidity('');
    get('scale-wrong').textContent = '';
    this.view.colour(this.colouring, low, high);
    this.legend(low, high);
  }

  // What is no scale is said beside the boxes, and the one that is shown stays.
  rescale() {
    const boxes = ['scale-low', 'scale-high'].map(get), [low, high] = boxes.map((b) => b.valueAsNumber);
    const wrong = Number.isNaN(low) || Number.isNaN(high) ? 'Both ends are numbers.'
      : low < high ? '' : 'The first is below the second.';
    for (const b of boxes) b.setCustomValidity(wrong);
    get('scale-wrong').textContent = wrong && `${wrong} The scale is still ${this.view.range.map((x) => +x.toPrecision(4)).join(' to ')}.`;
    if (wrong) return;
    this.view.scale(low, high);
    this.legend(low, high);
  }

  legend(low, high) {
    this.view.canvas.setAttribute('aria-label', `The mesh in three dimensions, coloured by ${this.colouring.title}`);
    drawLegend(get('legend'), this.colouring, low, high, (i) => css(this.colouring.table, i));
  }

  bindParts(hasReference, names) {
    get('parts').hidden = !hasReference;
    if (names) {
      get('tag-left').textContent = names[0];
      get('tag-right').textContent = names[1];
      get('name-result').textContent = 'Second';
      get('name-reference').textContent = 'First';
    }
    const blend = get('blend'), radios = [...document.querySelectorAll('input[name=part]')];
    const update = () => {
      const part = radios.find((r) => r.checked).value;
      blend.disabled = part !== 'blend';
      for (const id of ['tag-left', 'tag-right']) get(id).hidden = part !== 'both';
      this.view.show(part, +blend.value / 100);
    };
    this.showPart = (part) => {
      for (const r of radios) r.checked = r.value === part;
      update();
    };
    radios.forEach((r) => r.addEventListener('change', update));
    blend.addEventListener('input', update);
  }

  bindCut() {
    const [on, axis, place, flip, text] = ['cut', 'cut-axis', 'cut-place', 'cut-flip', 'cut-text'].map(get);
    this.updateCut = () => {
      const a = +axis.value, share = +place.value / 1000, { low, high } = this.frame;
      const at = low[a] + share * (high[a] - low[a]), step = (high[a] - low[a]) / 1000;
      text.value = `${'xyz'[a]} = ${step > 0 ? +at.toFixed(Math.min(100, Math.max(0, Math.ceil(-Math.log10(step))))) : at} ${this.unit}`;
      this.view.setCut({ on: on.checked, axis: a, place: share, flip: flip.checked });
    };
    on.addEventListener('change', this.updateCut);
    flip.addEventListener('change', this.updateCut);
    axis.addEventListener('change', this.updateCut);
    place.addEventListener('input', () => {
      on.checked = true;
      this.updateCut();
    });
    this.updateCut();
  }

  bindKeys() {
    const { view } = this, place = get('cut-place');
    const moveCut = (by) => { place.value = +place.value + by; get('cut').checked = true; this.updateCut(); };
    const actions = {
      ArrowLeft: (s) => (s ? view.move(-1, 0) : view.turn(-10, 0)), ArrowRight: (s) => (s ? view.move(1, 0) : view.turn(10, 0)),
      ArrowUp: (s) => (s ? view.move(0, 1) : view.turn(0, -10)), ArrowDown: (s) => (s ? view.move(0, -1) : view.turn(0, 10)),
      '+': () => view.zoom(1.25), '=': () => view.zoom(1.25), '-': () => view.zoom(0.8), Home: () => view.look('all'),
      c: () => { get('cut').checked = !get('cut').checked; this.updateCut(); }, '[': () => moveCut(-20), ']': () => moveCut(20),
    };
    view.canvas.addEventListener('keydown', (event) => {
      const action = actions[event.key];
      if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      action(event.shiftKey);
    });
  }
}
