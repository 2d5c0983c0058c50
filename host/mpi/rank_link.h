#pragma once

#include <mpi.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <vector>

#include "host/worker_pool/message.h"

namespace emax {

// Between two looks at what arrives, since MPI's own waiting takes a whole processor. An evaluation
// takes longer than a hundred of them.
inline constexpr std::chrono::milliseconds kBetweenLooks{1};

enum class RankMessageKind : std::uint64_t {
  // To a rank.
  kPoints,  // content: the "points" message, for the pools that are started from now on
  kStart,   // a pool; content: RankPoolOptions
  kRun,     // content: the "run" message
  kStop,    // EvaluationPool::stop()
  kEnd,     // of the pool
  kTile,    // content: TileTask; kStop ends it soon
  kPart,    // content: the "part" message
  kPieces,  // content: PiecesTask; kEndPieces ends it soon
  kEndPieces,
  kQuit,  // of the program
  // From a rank.
  kMesh,     // content: the "mesh" message
  kFailure,  // content: one byte, the reason, then the message
  kDecimatedTile,
  kPartDone,
  kPieceFound,  // content: PieceFindings
  kPiecesDone,  // content: MeterParts, or nothing where rank 0 ended it
  kUnusable,    // content: a text; no evaluation can be made there
};

struct RankMessage {
  RankMessageKind kind;
  std::uint64_t pool = 0;    // its number, from 1
  std::uint64_t ticket = 0;  // of an evaluation, or a tile's number
  std::shared_ptr<const Bytes> content = std::make_shared<Bytes>();
};

// Messages of any length between the ranks of a communicator. They arrive whole, and those of one
// rank in the order in which it sent them. An error of MPI ends the job, as a lost rank does.
class RankLink {
 public:
  explicit RankLink(MPI_Comm communicator) : communicator_(communicator) {}
  RankLink(const RankLink&) = delete;
  RankLink& operator=(const RankLink&) = delete;
  ~RankLink();  // waits until everything was sent

  int rank() const;
  int size() const;

  // Returns at once; what is sent is on its way while receive() is called.
  void send(int to, RankMessage message);

  struct Received {
    int from;
    RankMessage message;
  };
  // How many messages are on their way.
  std::size_t unsent() const { return sending_.size(); }

  // A message that is arriving, from any rank; nothing where there is none.
  std::optional<Received> receive();

 private:
  struct Sending {
    RankMessage message;
    std::array<std::uint64_t, 4> header;
    std::vector<MPI_Request> requests;
  };
  void drop_sent();

  MPI_Comm communicator_;
  std::list<Sending> sending_;  // buffers that MPI still reads
};

}  // namespace emax
