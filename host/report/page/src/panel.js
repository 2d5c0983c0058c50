// The controls around the view, its legend, and what keys, wheel and touch do.
import { el, table } from './dom.js';
import { integer, number, percent } from './format.js';
import { pick } from './pick.js';
import { point_text } from './sections.js';
import { unit_of } from './answer.js';

const SIDES = ['front', 'back', 'left', 'right', 'top', 'bottom', 'isometric'];
const TURN = Math.PI / 24; // for each press of an arrow key
const PICTURE_MS = 400; // of rest before the view is kept for printing
const CLICK_PIXELS = 4;
const NOTHING_SAID = 'A click on a point says its deviation.';

const capital = (word) => word[0].toUpperCase() + word.slice(1);

const choice = (id, label, checked, change) => el('label', { class: 'switch' },
  el('input', { type: 'checkbox', id, checked, onchange: (event) => change(event.target.checked) }), label);

function options(id, label, names, change) {
  return el('label', { class: 'options', for: id }, el('span', {}, label),
    el('select', { id, onchange: (event) => change(event.target.value) },
      names.map(([value, text]) => el('option', { value }, text))));
}

const group = (label, ...content) => el('div', { class: 'group', role: 'group', 'aria-label': label }, content);

/** The legend, and a function that draws it anew. */
function legend(data, scale) {
  const box = el('div', { id: 'legend' });
  const redraw = () => {
    const total = data.statistics?.count || 1;
    const rows = data.histogram && data.statistics ? scale.rows(data.histogram, data.statistics) : [];
    const swatch = (background) => el('span', { class: 'swatch', style: `background: ${background}` });
    box.replaceChildren(
      el('h2', {}, `${data.signed ? 'Deviation' : 'Distance'} [${unit_of(data)}]`),
      table('Share of the points in each band', [{ text: '' }, { text: 'band' }, { text: 'points', number: true }],
        rows.map(({ name, background, count }) => [swatch(background), name, percent(count / total)])));
    if (data.epsilon !== null && !scale.go_no_go) {
      box.append(el('p', { class: 'note' }, `The scale ends at ${data.signed ? '±ε' : 'ε'} = ${data.signed ? '±' : ''}${number(data.epsilon, 5)}.`));
    }
    if (data.excluded?.length) box.append(el('p', { class: 'note' }, el('span', { class: 'cross', 'aria-hidden': 'true' }, '✕ '), 'excluded point'));
  };
  redraw();
  return { box, redraw };
}

function section_controls(view, unit) {
  let [axis, share, upper] = [null, 0.5, false];
  const said = el('output', { for: 'section-place' });
  const slider = el('input', { type: 'range', id: 'section-place', min: 0, max: 1, step: 0.002, value: share, disabled: true, 'aria-label': 'Place of the section' });
  const side = el('button', { type: 'button', id: 'section-side', disabled: true }, 'Other side');
  const cut = () => {
    const at = view.cut(axis, share, upper);
    slider.disabled = side.disabled = axis === null;
    said.textContent = at === null ? '' : `${'xyz'[axis]} = ${number(at, 4)}${unit}`;
  };
  slider.addEventListener('input', () => { share = Number(slider.value); cut(); });
  side.addEventListener('click', () => { upper = !upper; cut(); });
  return group('Section', options('section-axis', 'Section', [['', 'none'], ['0', 'across x'], ['1', 'across y'], ['2', 'across z']],
    (value) => { axis = value === '' ? null : Number(value); cut(); }), slider, side, said);
}

function toolbar(view, data, scale, changed) {
  const set = (name) => (value) => view.show({ [name]: value });
  const scales = [['', 'by deviation']];
  if (data.epsilon !== null) scales.push(['go', 'go / no-go']);
  return el('div', { id: 'toolbar' },
    group('Views', SIDES.map((side) => el('button', {
      type: 'button', id: `look-${side}`, onclick: () => { view.stop(); view.look(side); } }, capital(side)))),
    group('Shown', choice('show-points', 'Points', true, set('points')), choice('show-faces', 'Mesh', true, set('faces')),
      choice('show-edges', 'Edges', true, set('edges')),
      data.excluded?.length ? choice('show-excluded', 'Excluded', true, set('excluded')) : null),
    group('Colours',
      options('colour-scale', 'Colours', scales, (value) => {
        scale.go_no_go = value === 'go';
        view.show({ go_no_go: scale.go_no_go });
        changed();
      }),
      options('colour-mesh', 'Triangles', [['plain', 'plain'], ['worst', 'by their worst point']],
        (value) => view.show({ coloured: value === 'worst' }))),
    section_controls(view, data.unit ? ` ${data.unit}` : ''));
}

// The view takes wheel and fingers only while it has the focus: else both scroll the page.
function focus_rules(view) {
  const { canvas, controls, stage } = view;
  const take = (taken) => {
    controls.enableZoom = taken;
    canvas.style.touchAction = taken ? 'none' : 'auto';
    stage.classList.toggle('active', taken);
  };
  take(false);
  canvas.tabIndex = 0;
  canvas.addEventListener('focus', () => take(true));
  canvas.addEventListener('blur', () => take(false));
  stage.addEventListener('pointerdown', (event) => {
    view.stop();
    controls.enabled = event.pointerType !== 'touch' || document.activeElement === canvas;
  }, { capture: true });
  canvas.addEventListener('click', () => canvas.focus({ preventScroll: true }));
}

function keys(view) {
  const acts = {
    ArrowLeft: () => view.turn(-TURN, 0), ArrowRight: () => view.turn(TURN, 0),
    ArrowUp: () => view.turn(0, TURN), ArrowDown: () => view.turn(0, -TURN),
    '+': () => view.zoom_by(1.25), '=': () => view.zoom_by(1.25), '-': () => view.zoom_by(0.8),
    Home: () => view.look('isometric'), Escape: () => view.canvas.blur() };
  view.canvas.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in acts)) return;
    event.preventDefault();
    view.stop();
    acts[event.key]();
  });
}

function clicks(view, data, say) {
  let down = null;
  view.canvas.addEventListener('pointerdown', (event) => { down = [event.clientX, event.clientY]; });
  view.canvas.addEventListener('click', (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > CLICK_PIXELS) return;
    const box = view.canvas.getBoundingClientRect();
    const found = pick(view, event.clientX - box.left, event.clientY - box.top);
    if (!found) return;
    view.mark(found.place);
    say(point_text(data, { deviation: found.deviation, position: found.place.toArray().map((value, i) => value + data.geometry.origin[i]) }));
  });
}

// The current picture stands in the place of the view on paper.
function printing(view, stage) {
  const printed = el('img', { class: 'printed', alt: 'Mesh and cloud as they were in view' });
  stage.append(printed);
  const keep = () => { printed.src = view.picture(); };
  let timer = null;
  let ours = false;
  view.on_drawn = () => {
    if (ours) return;
    clearTimeout(timer);
    timer = setTimeout(() => { ours = true; keep(); ours = false; }, PICTURE_MS);
  };
  addEventListener('beforeprint', keep);
}

/** Puts controls, legend and what is said of points around the view. Returns `go(point, triangle)`. */
export function show_panel(view, data, scale, model, stage) {
  const { box, redraw } = legend(data, scale);
  const said = el('p', { id: 'said', class: 'note', role: 'status' }, NOTHING_SAID);
  const say = (text) => {
    said.textContent = text;
    said.classList.remove('note');
  };
  const { points, points_of } = data.geometry;
  const thinned = points < points_of ? ` ${integer(points)} of ${integer(points_of)} points are drawn; the worst are among them.` : '';
  view.canvas.setAttribute('role', 'img');
  view.canvas.setAttribute('aria-label', 'Mesh and cloud; arrow keys turn, plus and minus zoom');
  view.canvas.id = 'view';
  stage.append(el('span', { class: 'hint', 'aria-hidden': 'true' }, 'Tap to turn'));
  model.prepend(toolbar(view, data, scale, redraw));
  model.append(box, said, el('p', { class: 'note', id: 'help' },
    el('span', { class: 'screen' }, 'Drag to turn, drag with the right button or two fingers to move. After a click the wheel zooms, and arrow keys, + and − work; Escape ends that.'),
    thinned));
  focus_rules(view);
  keys(view);
  clicks(view, data, say);
  printing(view, stage);
  return (point, triangle) => {
    view.fly_to(point.position, triangle);
    say(point_text(data, point));
    stage.scrollIntoView({ block: 'nearest', behavior: 'auto' });
  };
}
