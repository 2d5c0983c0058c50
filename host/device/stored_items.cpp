#include "host/device/stored_items.h"

#include <algorithm>

#include "sw_model/base/deliberate_fault.h"

namespace emax {

void StoredItems::set(std::vector<Word> words, std::size_t base, std::size_t kept) {
  const std::size_t count = words.size() / size_;
  std::vector<bool> there(count, false);
  if (base == base_) {
    for (std::size_t i = 0; i < std::min({kept, kept_, count, there_.size()}); ++i) {
      const auto at = static_cast<std::ptrdiff_t>(i * size_);
      const auto end = at + static_cast<std::ptrdiff_t>(size_);
      there[i] =
          there_[i] && (EMAX_FAULT(kStoreTrustsOldItems) ||
                        std::equal(words.begin() + at, words.begin() + end, words_.begin() + at));
    }
  }
  words_ = std::move(words);
  there_ = std::move(there);
  base_ = base;
  kept_ = std::min(kept, count);
}

void StoredItems::append(std::span<const std::uint32_t> items, std::vector<Word>& stores,
                         std::vector<Word>& pieces) {
  for (std::size_t i = 0; i < items.size();) {
    std::size_t end = i + 1;
    while (end < items.size() && items[end] == items[end - 1] + 1) ++end;
    const std::size_t first = items[i], last = first + (end - i);
    append_stores(first, last, stores);
    append_pieces(pieces, base_ + first * size_, (last - first) * size_);
    i = end;
  }
}

void StoredItems::append_stores(std::size_t first, std::size_t last, std::vector<Word>& stores) {
  for (std::size_t i = first; i < last;) {
    if (there_[i]) {
      ++i;
      continue;
    }
    std::size_t end = i;
    for (; end < last && !there_[end]; ++end) there_[end] = true;
    append_store(stores, base_ + i * size_,
                 std::span(words_).subspan(i * size_, (end - i) * size_));
    i = end;
  }
}

void StoredItems::lose_from(std::size_t address) {
  for (std::size_t i = 0; i < there_.size(); ++i) {
    if (base_ + (i + 1) * size_ > address) there_[i] = false;
  }
}

void append_pieces(std::vector<Word>& pieces, std::size_t address, std::size_t words) {
  while (words > 0) {
    const std::size_t part = std::min<std::size_t>(words, kMaxPieceWords);
    pieces.push_back(store_piece(static_cast<Word>(address), static_cast<Word>(part)));
    address += part;
    words -= part;
  }
}

void append_store(std::vector<Word>& commands, std::size_t address, std::span<const Word> words) {
  commands.push_back(command_header(kStore, static_cast<Word>(1 + words.size())));
  commands.push_back(static_cast<Word>(address));
  commands.insert(commands.end(), words.begin(), words.end());
}

void append_recall(std::vector<Word>& commands, Word header, std::span<const Word> pieces) {
  commands.push_back(command_header(kRecall, static_cast<Word>(1 + pieces.size())));
  commands.push_back(header);
  commands.insert(commands.end(), pieces.begin(), pieces.end());
}

}  // namespace emax
