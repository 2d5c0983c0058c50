#pragma once

#include <span>

#include "host/tiles/tile.h"
#include "host/worker_pool/message.h"

namespace emax {

// A tile on its way to a rank, and what comes back: CBOR maps, points and indices as byte strings.
struct TileTask {
  Tile tile;
  DecimationSettings settings;  // without functions and threads
};
Bytes encode(const TileTask& task);
TileTask decode_tile_task(std::span<const std::uint8_t> bytes);

Bytes encode(const DecimatedTile& result);
DecimatedTile decode_decimated_tile(std::span<const std::uint8_t> bytes);

}  // namespace emax
