#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "host/app/piece_meter.h"
#include "host/app/scan_pieces.h"

namespace emax {

// The files of the meshes that a meter has, for processes that read them again.
struct MeterFiles {
  std::filesystem::path mesh, reference;  // empty: of no file; none
  bool used_vertices_alone = false;       // vertices without a triangle are dropped
};

// Where the pieces of a cloud are measured.
class PieceRunner {
 public:
  virtual ~PieceRunner() = default;

  // Those of all processes that share the pieces of this cloud, as ScanPieces takes them.
  virtual std::size_t threads(const std::filesystem::path& cloud,
                              const MeterFiles& files) const = 0;

  using Take = std::function<void(PieceFindings)>;
  // Measures every piece of the scan. `take` is called for each, by several threads at a time, in
  // any order. In the end the meter has certified all pieces. Throws as ScanPieces::for_each() and
  // PieceMeter::measure().
  virtual void run(const ScanPieces& scan, PieceMeter& meter, const MeterFiles& files,
                   const PieceQuestion& question, const std::function<bool()>& interrupted,
                   const Take& take) = 0;
};

// On the threads of this processor.
class LocalPieces final : public PieceRunner {
 public:
  std::size_t threads(const std::filesystem::path&, const MeterFiles&) const override { return 0; }
  void run(const ScanPieces& scan, PieceMeter& meter, const MeterFiles& files,
           const PieceQuestion& question, const std::function<bool()>& interrupted,
           const Take& take) override;
};

}  // namespace emax
