// What a device does with a block: every record meets every point.

typedef union {
  word all;
  uint lane[LANES];
} Lanes;

// Point groups of LANES along the first dimension, slices of `slice` records along the second. Each
// item meets its points with its slice and lowers their running minima, which are words that order
// like their values.
kernel void meet_records(const global real* x, const global real* y, const global real* z,
                         const uint groups, const global uint* records, const uint record_count,
                         const uint slice, global uint* nearest) {
  const uint group = get_global_id(0);
  if (group >= groups) return;
  const uint first = get_global_id(1) * slice;
  const uint end = min(first + slice, record_count);
  Lanes least = {splat_word(INFINITY_WORD)};
  for (uint i = first; i < end; ++i) {
    const real squared = emax_distance(x[group], y[group], z[group], records + i * RECORD_WORDS);
    least.all = emax_minimum(least.all, as_word(squared));
  }
  for (uint i = 0; i < LANES; ++i) atomic_min(nearest + group * LANES + i, least.lane[i]);
}

// The operators on pairs of words: sum, difference, product, whether less. For the self-test.
kernel void operate(const global uint* a, const global uint* b, global uint* results) {
  const uint i = get_global_id(0), n = get_global_size(0);
  const real first = fp_flushed(splat(a[i])), second = fp_flushed(splat(b[i]));
  const Lanes each[4] = {{as_word(fp_canonical(fp_add(first, second)))},
                         {as_word(fp_canonical(fp_subtract(first, second)))},
                         {as_word(fp_canonical(fp_multiply(first, second)))},
                         {as_word(select(splat(0), splat(1), fp_less(first, second)))}};
  for (uint k = 0; k < 4; ++k) results[k * n + i] = each[k].lane[LANES - 1];
}
