// What stands below the view: distribution, worst points, what was left out, the search.
import { histogram, progress } from './charts.js';
import { el, pairs, section, table } from './dom.js';
import { deviation, integer, number, percent, position, seconds } from './format.js';
import { unit_of } from './answer.js';

const count_text = (count, thing = 'point') => `${integer(count)} ${thing}${count === 1 ? '' : 's'}`;

function statistics(data) {
  const { statistics: s, signed, epsilon } = data;
  const value = (number_) => deviation(number_, signed);
  const share = (count) => (count === null ? null : `${integer(count)} (${percent(count / s.count)})`);
  const rows = [
    ['points', integer(s.count)], ['minimum', value(s.min)], ['maximum', value(s.max)],
    ['mean', value(s.mean)], ['RMS', number(s.rms)], ['standard deviation σ', number(s.sigma)],
    ...(s.within_sigma ?? []).map((part, i) => [`within ${i + 1}σ`, percent(part)])];
  if (epsilon !== null) {
    if (s.above !== null) rows.push([signed ? 'above +ε' : 'beyond ε', share(s.above)]);
    if (s.within !== null) rows.push(['within ε', share(s.within)]);
    if (signed && s.below !== null) rows.push(['below −ε', share(s.below)]);
  }
  return el('div', { class: 'statistics' }, pairs('Statistics', rows),
    el('p', { class: 'note' }, `Lengths in ${data.unit ?? 'the cloud’s unit'}. ${signed
      ? 'A deviation is positive where the point lies outside of the mesh.'
      : 'Distances have no sign, as the mesh is not consistently oriented.'}`));
}

function distribution(data, scale) {
  if (!data.histogram || !data.statistics) return null;
  return section('distribution', 'Distribution of the points',
    el('div', { class: 'beside' }, histogram(data, scale, unit_of(data)), statistics(data)));
}

// A point's number as a button that leads to the point, or as text where there is no view.
function leads_to(point, go, triangle) {
  const text = integer(point.point);
  if (!go) return text;
  return el('button', {
    type: 'button', class: 'goto', 'aria-label': `Show point ${text}`, onclick: () => go(point, triangle) }, text);
}

function points_table(caption, list, data, go, triangles) {
  const unit = unit_of(data);
  const heads = [{ text: 'point', number: true }, { text: `deviation [${unit}]`, number: true },
    ...['x', 'y', 'z'].map((text) => ({ text, number: true }))];
  if (data.epsilon) heads.splice(2, 0, { text: '% of ε', number: true });
  if (triangles) heads.push({ text: 'triangle', number: true });
  return table(caption, heads, list.map((point) => {
    const row = [leads_to(point, go, point.triangle), deviation(point.deviation, data.signed, 6),
      ...point.position.map((value) => number(value, 7))];
    if (data.epsilon) row.splice(2, 0, number((100 * Math.abs(point.deviation)) / data.epsilon, 4));
    if (triangles) row.push(integer(point.triangle));
    return row;
  }));
}

function worst(data, go) {
  if (!data.worst?.length) return null;
  return section('worst', 'Worst points',
    go ? el('p', { class: 'note screen' }, 'A number of a point leads to it in the view.') : null,
    points_table('Worst points', data.worst, data, go, true));
}

function left_out(data, go) {
  const excluded = data.excluded ?? [];
  const count = data.excluded_count ?? excluded.length;
  return section('left-out', 'Points left out',
    data.left_out?.length
      ? pairs('Points left out', data.left_out.map(({ reason, points }) => [reason, count_text(points)])) : null,
    count > 0 ? el('p', {}, `${count_text(count)} left out as outliers${excluded.length < count
      ? `; ${integer(excluded.length)} of them are listed` : ''}. The tolerance does not hold there.`) : null,
    excluded.length > 0 ? points_table('Excluded points', excluded, data, go, false) : null);
}

function search(data) {
  const evaluations = data.search?.evaluations ?? [];
  if (evaluations.length === 0) return null;
  const values = (x) => evaluations.map((e) => ({ x: e[x] ?? NaN, y: e.triangles ?? NaN, good: e.feasible }));
  return section('search', 'Convergence of the search',
    el('div', { class: 'charts' }, [
      progress('Triangles by evaluation', 'evaluation', values('index'), { best: true, x_text: integer }),
      progress('Triangles by time', 'time', values('seconds'), { best: true, x_text: seconds })].filter(Boolean)),
    el('p', { class: 'note' }, `${count_text(evaluations.length, 'evaluation')}. The line is the least number of triangles so far within the tolerance; a hollow mark exceeds the tolerance.`));
}

function curve(data) {
  const chart = data.curve && progress('Triangles by tolerance', `tolerance ε [${unit_of(data)}]`,
    data.curve.map(({ epsilon, triangles }) => ({ x: epsilon, y: triangles ?? NaN, good: true })));
  return section('curve', 'Triangles by tolerance', chart);
}

function times(data) {
  if (!data.times?.length) return null;
  const total = data.times.reduce((sum, { seconds: s }) => sum + s, 0) || 1;
  return section('times', 'Where the time went', table('Times',
    [{ text: 'phase' }, { text: 'time', number: true }, { text: 'share', number: true }, { text: '' }],
    data.times.map(({ name, seconds: s }) => [name, seconds(s), percent(s / total),
      el('span', { class: 'share', style: `width: ${(100 * s) / total}%`, 'aria-hidden': 'true' })])));
}

/** Fills the element with the sections that the data have. `go(point, triangle)` leads to a point; null without a view. */
export function show_sections(data, scale, go, element) {
  element.replaceChildren(...[distribution(data, scale), worst(data, go), left_out(data, go), search(data),
    curve(data), times(data)].filter(Boolean));
}

/** What is said of a point that the reader chose. */
export function point_text(data, point) {
  const name = point.point === undefined ? 'Point' : `Point ${integer(point.point)}`;
  const unit = data.unit ? ` ${data.unit}` : '';
  const triangle = Number.isInteger(point.triangle) ? `, nearest triangle ${integer(point.triangle)}` : '';
  return `${name}: ${data.signed ? 'deviation' : 'distance'} ${deviation(point.deviation, data.signed, 5)}${unit} at ${position(point.position)}${triangle}`;
}
