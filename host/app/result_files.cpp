#include "host/app/result_files.h"

#include <deque>

#include "host/geometry/atomic_file.h"

namespace emax {

void write_together(std::span<const ResultFile> files) {
  std::deque<AtomicFile> written;
  for (const ResultFile& file : files) written.emplace_back(file.path).write(file.bytes);
  for (AtomicFile& file : written) file.commit();
}

}  // namespace emax
