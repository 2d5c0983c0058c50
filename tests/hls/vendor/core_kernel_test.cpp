#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "Vcard_wrapper.h"

namespace {

// A card's wrapper of the core, around stub/emax_core.sv.
class CardWrapper : public testing::Test {
 protected:
  CardWrapper() {
    top_->m_axis_answer_tready = 1;
    for (int i = 0; i < 3; ++i) clock();
    top_->ap_rst_n = 1;
  }

  // One cycle. Answer words are kept.
  void clock() {
    top_->ap_clk = 0;
    top_->eval();
    if (top_->m_axis_answer_tvalid && top_->m_axis_answer_tready) {
      answers_.push_back(top_->m_axis_answer_tdata);
    }
    top_->ap_clk = 1;
    top_->eval();
  }

  // Offers a word until it is taken: cycles that it waited.
  int send(unsigned word) {
    top_->s_axis_command_tdata = word;
    top_->s_axis_command_tvalid = 1;
    for (int waited = 0; waited < 100; ++waited) {
      top_->ap_clk = 0;
      top_->eval();
      const bool taken = top_->s_axis_command_tready;
      clock();
      if (taken) {
        top_->s_axis_command_tvalid = 0;
        return waited;
      }
    }
    ADD_FAILURE() << "no word is taken any more";
    return -1;
  }

  void reset_by_word() {
    EXPECT_EQ(top_->s_axis_reset_tready, 1);
    top_->s_axis_reset_tvalid = 1;
    clock();
    top_->s_axis_reset_tvalid = 0;
  }

  std::unique_ptr<Vcard_wrapper> top_ = std::make_unique<Vcard_wrapper>();
  std::vector<unsigned> answers_;
};

TEST_F(CardWrapper, PassesWordsAfterItsReset) {
  EXPECT_GE(send(7), 16);
  EXPECT_LE(send(8), 2);
  for (int i = 0; i < 5; ++i) clock();
  EXPECT_EQ(answers_, (std::vector<unsigned>{7, 0x10008}));
}

TEST_F(CardWrapper, AWordResetsTheCoreAndNothingPassesMeanwhile) {
  send(1);
  send(2);
  for (int i = 0; i < 5; ++i) clock();
  ASSERT_EQ(answers_.size(), 2u);
  // An answer that nobody takes is forgotten with the rest.
  top_->m_axis_answer_tready = 0;
  send(3);
  clock();
  reset_by_word();
  top_->m_axis_answer_tready = 1;
  EXPECT_GE(send(4), 16);
  for (int i = 0; i < 5; ++i) clock();
  EXPECT_EQ(answers_, (std::vector<unsigned>{1, 0x10002, 4}));
}

TEST_F(CardWrapper, EveryWordOfAResetHoldsItAnew) {
  send(1);
  for (int i = 0; i < 3; ++i) {
    reset_by_word();
    for (int j = 0; j < 10; ++j) clock();
  }
  EXPECT_GE(send(2), 6);
  for (int i = 0; i < 5; ++i) clock();
  EXPECT_EQ(answers_.back(), 2u);
}

}  // namespace
