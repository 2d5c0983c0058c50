// The scale of colours: the same for points, triangles, legend and histogram.
import { deviation } from './format.js';

const rgb = (bytes) => bytes.map((part) => part / 255);
const WITHIN = rgb([79, 147, 196]);
const MOST_BANDS = 12;

const css = (colour) => `rgb(${colour.map((part) => Math.round(255 * part)).join(' ')})`;

/** The number of bands that divides the bins of the histogram: ten, or what is nearest to ten. */
function band_count(bins) {
  let best = 1;
  for (let count = 1; count <= Math.min(bins, MOST_BANDS); ++count) {
    if (bins % count === 0 && Math.abs(count - 10) < Math.abs(best - 10)) best = count;
  }
  return best > 3 ? best : Math.min(bins, 10);
}

export class Scale {
  /** Of the data of a report. */
  constructor(data) {
    const edges = data.histogram?.edges ?? [];
    this.signed = Boolean(data.signed);
    this.epsilon = data.epsilon;
    this.range = Math.abs(edges.at(-1) ?? data.epsilon ?? data.e_max) || Number.MIN_VALUE;
    this.stops = data.colours.stops.map(rgb);
    this.above = rgb(data.colours.above);
    this.below = rgb(data.colours.below);
    this.within = WITHIN;
    this.go_no_go = false;
  }

  /** The colour of a deviation, as [r, g, b] between 0 and 1; shaders.js says the same. */
  colour(value) {
    if (this.go_no_go) {
      if (value > this.epsilon) return this.above;
      return value < -this.epsilon ? this.below : this.within;
    }
    if (value > this.range) return this.above;
    if (value < -this.range) return this.below;
    const place = (this.signed ? value / this.range / 2 + 0.5 : value / this.range) * (this.stops.length - 1);
    const low = Math.min(Math.max(Math.floor(place), 0), this.stops.length - 2);
    return this.stops[low].map((part, i) => part + (this.stops[low + 1][i] - part) * (place - low));
  }

  css(value) { return css(this.colour(value)); }

  gradient(low, high) {
    const steps = [0, 0.25, 0.5, 0.75, 1].map((t) => this.css(low + (high - low) * t));
    return `linear-gradient(to top, ${steps.join(', ')})`;
  }

  /** Rows of the legend, the greatest first: { name, background, count }. */
  rows(histogram, statistics) {
    return this.go_no_go ? this.#verdict_rows(statistics) : this.#band_rows(histogram);
  }

  #verdict_rows(statistics) {
    const limit = deviation(this.epsilon, false);
    const rows = [
      { name: this.signed ? `above +${limit}` : `beyond ${limit}`, background: css(this.above), count: statistics.above },
      { name: 'within the tolerance', background: css(this.within), count: statistics.within }];
    if (this.signed) rows.push({ name: `below −${limit}`, background: css(this.below), count: statistics.below });
    return rows;
  }

  #band_rows({ edges, counts, above, below }) {
    const text = (value) => deviation(value, this.signed, 3);
    const rows = [];
    const count = band_count(counts.length);
    for (let band = count - 1; band >= 0; --band) {
      const first = Math.round((band * counts.length) / count);
      const last = Math.round(((band + 1) * counts.length) / count);
      rows.push({
        name: `${text(edges[first])} to ${text(edges[last])}`,
        background: this.gradient(edges[first], edges[last]),
        count: counts.slice(first, last).reduce((sum, n) => sum + n, 0) });
    }
    if (above > 0 || this.epsilon !== null) {
      rows.unshift({ name: `above ${text(this.range)}`, background: css(this.above), count: above });
    }
    if (this.signed && (below > 0 || this.epsilon !== null)) {
      rows.push({ name: `below ${text(-this.range)}`, background: css(this.below), count: below });
    }
    return rows;
  }
}
