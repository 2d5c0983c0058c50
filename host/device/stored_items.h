#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hls/kernel/command_words.h"

namespace emax {

// Items of equal size, points or records, that lie one behind the other in the store of a board. An
// item is sent when it is first asked for and stays there until another one takes its place.
class StoredItems {
 public:
  explicit StoredItems(std::size_t words_of_item) : size_(words_of_item) {}

  // The items from now on, and where the first of them has its place, in words; `kept` of them have
  // one. An item whose words and place are as before is still there. O(words).
  void set(std::vector<Word> words, std::size_t base, std::size_t kept);

  std::size_t count() const { return words_.size() / size_; }
  std::size_t words_of_item() const { return size_; }
  bool has_place(std::size_t item) const { return item < kept_; }
  std::span<const Word> words_of(std::size_t item) const {
    return std::span(words_).subspan(item * size_, size_);
  }

  // Appends to `stores` the commands that store those of the items that are not there, and to
  // `pieces` where all of them are, in order. Neighbours share a command and a piece. All have
  // places.
  void append(std::span<const std::uint32_t> items, std::vector<Word>& stores,
              std::vector<Word>& pieces);

  // Other words were or will be written from this address on.
  void lose_from(std::size_t address);

 private:
  void append_stores(std::size_t first, std::size_t last, std::vector<Word>& stores);

  std::size_t size_;
  std::vector<Word> words_;
  std::vector<bool> there_;
  std::size_t base_ = 0, kept_ = 0;
};

// Appends pieces for so many words from this address on.
void append_pieces(std::vector<Word>& pieces, std::size_t address, std::size_t words);
// Appends the command that stores these words.
void append_store(std::vector<Word>& commands, std::size_t address, std::span<const Word> words);
// Appends the command that makes one with this header of the pieces.
void append_recall(std::vector<Word>& commands, Word header, std::span<const Word> pieces);

}  // namespace emax
