#include "host/app/piece_runner.h"

#include "sw_model/base/parallel.h"

namespace emax {

void LocalPieces::run(const ScanPieces& scan, PieceMeter& meter, const MeterFiles&,
                      const PieceQuestion& question, const std::function<bool()>& interrupted,
                      const Take& take) {
  scan.for_each(processor_threads(), [&](const ScanPieces::Piece& piece) {
    take(meter.measure(piece, question, interrupted));
  });
}

}  // namespace emax
