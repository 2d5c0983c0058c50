// Numbers as people read them. A minus is U+2212, so that it is as wide as a plus.

const grouped = (digits) => digits.replace(/\B(?=(\d{3})+(?!\d))/g, ',');

/** The digits of toPrecision, without an exponent where a person would write none. */
function plain(value, digits) {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) {
    return value.toExponential(digits - 1).replace(/\.?0*e\+?/, 'e');
  }
  const [whole, fraction] = Number(value.toPrecision(digits)).toFixed(
    size === 0 ? 0 : Math.max(0, digits - 1 - Math.floor(Math.log10(size)))).split('.');
  const kept = fraction ? fraction.replace(/0+$/, '') : '';
  return kept ? `${grouped(whole)}.${kept}` : grouped(whole);
}

const known = (value) => typeof value === 'number' && Number.isFinite(value);

/** A number of at most so many significant digits; a dash where it is not known. */
export function number(value, digits = 4) {
  return known(value) ? plain(value, digits).replace('-', '−') : '–';
}

/** A deviation: with its sign where deviations have one. */
export function deviation(value, signed, digits = 4) {
  return known(value) && signed && value > 0 ? `+${number(value, digits)}` : number(value, digits);
}

export const integer = (value) => (known(value) ? grouped(String(Math.round(value))) : '–');

export function percent(share) {
  if (!known(share)) return '–';
  const value = 100 * share;
  if (value > 0 && value < 0.01) return '< 0.01 %';
  if (value < 100 && value > 99.99) return '> 99.99 %';
  return `${value.toFixed(value < 10 ? 2 : 1).replace(/\.?0+$/, '')} %`;
}

export function seconds(value) {
  if (!known(value)) return '–';
  if (value < 120) return `${plain(value, value < 10 ? 2 : 3)} s`;
  const whole = Math.round(value);
  const hours = Math.floor(whole / 3600);
  const two = (n) => String(n).padStart(2, '0');
  return hours ? `${hours}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)} h`
    : `${Math.floor(whole / 60)}:${two(whole % 60)} min`;
}

export const position = (xyz, digits = 6) => `(${xyz.map((value) => number(value, digits)).join(', ')})`;

/** The nearest number of so many digits that is not below (way = 1) or not above (-1) the value. */
function rounded(value, digits, way) {
  const near = Number(value.toPrecision(digits));
  if (value === 0 || (near - value) * way >= 0) return near;
  const unit = 10 ** (Math.floor(Math.log10(Math.abs(value))) + 1 - digits);
  return Number((near + way * unit).toPrecision(digits));
}

/**
 * The texts of errors and of the tolerance they are compared with. An error is never rounded down, the
 * tolerance never up, and there are as many digits as keep their order.
 */
export function compared(errors, tolerance) {
  for (let digits = 5; digits < 17; ++digits) {
    const ups = errors.map((error) => (known(error) ? rounded(error, digits, 1) : error));
    const down = known(tolerance) ? rounded(tolerance, digits, -1) : tolerance;
    if (!known(tolerance) || errors.every((error, i) => !known(error) || ups[i] <= down === error <= tolerance)) {
      return [ups, down].flat().map((value) => number(value, digits));
    }
  }
  return [...errors, tolerance].map((value) => number(value, 17));
}
