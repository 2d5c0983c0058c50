// Charts as SVG, drawn for the width that they have.
import { deviation, integer, number, percent } from './format.js';
import { el, svg } from './dom.js';

const PAPER_WIDTH = 440; // letters are as large on paper as those of the text
const MARGIN = { left: 62, right: 16, top: 14, bottom: 40 };

/** Round numbers from low to high, about `wanted` of them. */
export function ticks(low, high, wanted) {
  const raw = (high - low) / wanted;
  if (!(raw > 0)) return [low];
  const unit = 10 ** Math.floor(Math.log10(raw));
  const step = unit * [1, 2, 5, 10].find((factor) => factor * unit >= raw);
  const found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) found.push(i * step);
  return found;
}

function log_ticks(low, high) {
  const found = [];
  for (let decade = Math.floor(Math.log10(low)); 10 ** decade <= high; ++decade) {
    for (const factor of [1, 2, 5]) {
      const value = factor * 10 ** decade;
      if (value >= low && value <= high) found.push(value);
    }
  }
  return found;
}

// A place on an axis: linear, or logarithmic where all values are positive and far apart.
function axis_of(low, high, from, to, log) {
  const turned = log ? Math.log : (value) => value;
  const [first, span] = [turned(low), turned(high) - turned(low) || 1];
  return (value) => from + ((turned(value) - first) / span) * (to - from);
}

/** A figure whose drawing `draw(width, height)` fills; it is drawn anew for another width. */
function figure(caption, height, draw) {
  const box = el('div', { class: 'chart' });
  let drawn = 0;
  const redraw = (width = Math.round(box.clientWidth)) => {
    if (width < 40 || width === drawn) return;
    drawn = width;
    box.replaceChildren(svg('svg', {
      viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': caption }, draw(width, height)));
  };
  new ResizeObserver(() => redraw()).observe(box);
  addEventListener('beforeprint', () => redraw(PAPER_WIDTH));
  addEventListener('afterprint', () => redraw());
  return el('figure', {}, el('figcaption', {}, caption), box);
}

function frame(width, height, x, y, labels) {
  const right = width - MARGIN.right;
  const floor = height - MARGIN.bottom;
  return [
    labels.y.map((value) => [
      svg('line', { class: 'grid', x1: MARGIN.left, x2: right, y1: y(value), y2: y(value) }),
      svg('text', { x: MARGIN.left - 8, y: y(value) + 4, 'text-anchor': 'end' }, labels.y_text(value))]),
    svg('line', { class: 'axis', x1: MARGIN.left, x2: right, y1: floor, y2: floor }),
    labels.x.map((value) => [
      svg('line', { class: 'axis', x1: x(value), x2: x(value), y1: floor, y2: floor + 4 }),
      svg('text', { x: x(value), y: floor + 17, 'text-anchor': x(value) > right - 24 ? 'end' : 'middle' }, labels.x_text(value))]),
    svg('text', { class: 'name', x: (MARGIN.left + right) / 2, y: height - 6, 'text-anchor': 'middle' }, labels.x_name)];
}

/** The histogram on the scale of the legend, with what lies beyond it in a bar at each end. */
export function histogram(data, scale, unit) {
  const { edges, counts, above, below } = data.histogram;
  const bars = counts.map((count, i) => ({
    count, low: edges[i], high: edges[i + 1], at: (edges[i] + edges[i + 1]) / 2,
    name: `${deviation(edges[i], scale.signed)} to ${deviation(edges[i + 1], scale.signed)}` }));
  const margin = (edges.at(-1) - edges[0]) / Math.max(12, counts.length / 2);
  const [first, last] = [edges[0], edges.at(-1)];
  if (above > 0) bars.push({ count: above, low: last + 0.25 * margin, high: last + margin, at: Infinity, name: `above ${deviation(last, scale.signed)}` });
  if (below > 0) bars.push({ count: below, low: first - margin, high: first - 0.25 * margin, at: -Infinity, name: `below ${deviation(first, scale.signed)}` });
  const total = bars.reduce((sum, bar) => sum + bar.count, 0) || 1;
  const most = Math.max(1, ...bars.map((bar) => bar.count));
  const draw = (width, height) => {
    const x = axis_of(first - (below > 0 ? margin : 0), last + (above > 0 ? margin : 0),
      MARGIN.left, width - MARGIN.right, false);
    const y = axis_of(0, most, height - MARGIN.bottom, MARGIN.top, false);
    const parts = width < 400 ? 2 : 4;
    const x_ticks = Array.from({ length: parts + 1 }, (_, i) => first + ((last - first) * i) / parts);
    return [
      frame(width, height, x, y, {
        x: x_ticks, x_text: (value) => deviation(value, scale.signed, 3), y: ticks(0, most, 4), y_text: integer,
        x_name: `${scale.signed ? 'deviation, + outside' : 'distance'} [${unit}]` }),
      bars.map((bar) => svg('rect', {
        class: 'bar', x: x(bar.low) + 0.5, width: Math.max(0.5, x(bar.high) - x(bar.low) - 1),
        y: y(bar.count), height: Math.max(0, y(0) - y(bar.count)), fill: scale.css(bar.at) },
      svg('title', {}, `${bar.name}: ${integer(bar.count)} points, ${percent(bar.count / total)}`))),
      limits(scale).map((limit) => svg('line', { class: 'limit', x1: x(limit), x2: x(limit), y1: MARGIN.top - 8, y2: y(0) })),
      limits(scale).map((limit) => svg('text', {
        class: 'limit', x: x(limit) + (limit > 0 ? -5 : 5), y: MARGIN.top, 'text-anchor': limit > 0 ? 'end' : 'start' },
      limit > 0 ? (scale.signed ? '+ε' : 'ε') : '−ε'))];
  };
  return figure('Points by deviation', 260, draw);
}

function limits(scale) {
  if (scale.epsilon === null || scale.epsilon > scale.range) return [];
  return scale.signed ? [-scale.epsilon, scale.epsilon] : [scale.epsilon];
}

/**
 * Values over an axis: points of { x, y, good }. `best` adds the line of the least good value so far,
 * which is level between points; else a line joins all points.
 */
export function progress(caption, x_name, points, { best = false, x_text = number } = {}) {
  const known = points.filter(({ x, y }) => Number.isFinite(x) && Number.isFinite(y))
    .sort((a, b) => a.x - b.x);
  if (known.length < 2) return null;
  const values = known.map(({ y }) => y);
  const [least, most] = [Math.min(...values), Math.max(...values)];
  const log = least > 0 && most > 12 * least;
  const [low, high] = log ? [least * 0.9, most * 1.1] : [0, most * 1.05];
  const [first, last] = [Math.min(0, known[0].x), known.at(-1).x];
  const draw = (width, height) => {
    const x = axis_of(first, last, MARGIN.left, width - MARGIN.right, false);
    const y = axis_of(low, high, height - MARGIN.bottom, MARGIN.top, log);
    const path = [];
    let least_so_far = Infinity;
    for (const point of known) {
      if (best && (!point.good || point.y >= least_so_far)) continue;
      if (best && path.length > 0) path.push(`H ${x(point.x)}`, `V ${y(point.y)}`);
      else path.push(`${path.length > 0 ? 'L' : 'M'} ${x(point.x)} ${y(point.y)}`);
      least_so_far = point.y;
    }
    if (best && path.length > 0) path.push(`H ${x(last)}`);
    return [
      frame(width, height, x, y, {
        x: ticks(first, last, width < 480 ? 3 : 5), x_text, x_name,
        y: log ? log_ticks(low, high) : ticks(low, high, 5), y_text: integer }),
      path.length > 0 ? svg('path', { class: 'line', d: path.join(' ') }) : null,
      known.map((point) => svg('circle', { class: point.good ? 'good' : 'bad', cx: x(point.x), cy: y(point.y), r: 3.5 },
        svg('title', {}, `${x_text(point.x)}: ${integer(point.y)} triangles${point.good ? '' : ', exceeds the tolerance'}`)))];
  };
  return figure(caption, 230, draw);
}
