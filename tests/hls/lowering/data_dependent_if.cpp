// Compiles as it stands; with EMAX_BRANCH it decides by data and must not.
#include "hls/lowering/recorded_value.h"

emax::RecordedValue larger(const emax::RecordedValue& a, const emax::RecordedValue& b) {
#ifdef EMAX_BRANCH
  if (a < b) return b;
  return a;
#else
  return select(a < b, b, a);
#endif
}
