#include "host/mpi/rank_link.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace emax {
namespace {

constexpr int kTag = 0;
constexpr std::size_t kBlock = std::size_t{1} << 30;  // MPI counts in int
constexpr int kHeaderBytes = 4 * sizeof(std::uint64_t);

// f(offset, length) for each block of so many bytes.
template <typename F>
void for_each_block(std::size_t bytes, F f) {
  for (std::size_t at = 0; at < bytes; at += kBlock) {
    f(at, static_cast<int>(std::min(kBlock, bytes - at)));
  }
}

}  // namespace

RankLink::~RankLink() {
  for (Sending& sending : sending_) {
    MPI_Waitall(static_cast<int>(sending.requests.size()), sending.requests.data(),
                MPI_STATUSES_IGNORE);
  }
}

int RankLink::rank() const {
  int rank = 0;
  MPI_Comm_rank(communicator_, &rank);
  return rank;
}

int RankLink::size() const {
  int size = 0;
  MPI_Comm_size(communicator_, &size);
  return size;
}

void RankLink::send(int to, RankMessage message) {
  drop_sent();
  Sending& sending = sending_.emplace_back();
  sending.message = std::move(message);
  const Bytes& content = *sending.message.content;
  sending.header = {static_cast<std::uint64_t>(sending.message.kind), sending.message.pool,
                    sending.message.ticket, content.size()};
  const auto begin = [&](const void* bytes, int length) {
    MPI_Isend(bytes, length, MPI_BYTE, to, kTag, communicator_,
              &sending.requests.emplace_back(MPI_REQUEST_NULL));
  };
  begin(sending.header.data(), kHeaderBytes);
  for_each_block(content.size(),
                 [&](std::size_t at, int length) { begin(content.data() + at, length); });
}

std::optional<RankLink::Received> RankLink::receive() {
  drop_sent();
  int arriving = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, kTag, communicator_, &arriving, &status);
  if (arriving == 0) return std::nullopt;
  const int from = status.MPI_SOURCE;
  std::array<std::uint64_t, 4> header{};
  MPI_Recv(header.data(), kHeaderBytes, MPI_BYTE, from, kTag, communicator_, MPI_STATUS_IGNORE);
  auto content = std::make_shared<Bytes>(header[3]);
  for_each_block(content->size(), [&](std::size_t at, int length) {
    MPI_Recv(content->data() + at, length, MPI_BYTE, from, kTag, communicator_, MPI_STATUS_IGNORE);
  });
  return Received{
      from, {static_cast<RankMessageKind>(header[0]), header[1], header[2], std::move(content)}};
}

void RankLink::drop_sent() {
  std::erase_if(sending_, [](Sending& sending) {
    int all = 0;
    MPI_Testall(static_cast<int>(sending.requests.size()), sending.requests.data(), &all,
                MPI_STATUSES_IGNORE);
    return all != 0;
  });
}

}  // namespace emax
