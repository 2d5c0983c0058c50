#pragma once

#include <cstdint>
#include <span>

#include "host/app/piece_meter.h"
#include "host/app/piece_runner.h"
#include "host/app/scan_pieces.h"
#include "host/worker_pool/message.h"

namespace emax {

// What a rank measures of a cloud, and what comes back: CBOR maps, numbers of points as byte
// strings.
struct PiecesTask {
  CloudCut cloud;
  MeterFiles files;
  std::uint32_t mesh_checksum = 0, reference_checksum = 0;
  bool brute_force = false;
  PieceQuestion question = {};
  PieceShare share = {};
};
Bytes encode(const PiecesTask& task);
PiecesTask decode_pieces_task(std::span<const std::uint8_t> bytes);

// Of the bits of the vertices and triangles.
std::uint32_t checksum(const TriangleMesh& mesh);

// The distances that are the kernel's are not sent, but made of its bits.
Bytes encode(const PieceFindings& found, const Normalization& normalization);
PieceFindings decode_piece_findings(std::span<const std::uint8_t> bytes,
                                    const Normalization& normalization);

// What the certificates of a meter have in the end.
struct MeterParts {
  CertificatePart mesh, reference;
};
Bytes encode(const MeterParts& parts);
MeterParts decode_meter_parts(std::span<const std::uint8_t> bytes);

}  // namespace emax
