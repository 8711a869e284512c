#include "server/http/suspended_calls.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "server/http/connection.hpp"
#include "tests/unit/server/http_fixture.hpp"

namespace symcell::server::test {
namespace {

using namespace std::chrono_literals;

// Tells how often it was looked at; over when told so.
class ProbeCall final : public SuspendedCall {
 public:
  std::shared_ptr<void> watch(std::function<void()> wake) override {
    wake_ = std::move(wake);
    return {this, [this](void*) { watched = false; }};
  }
  bool look(Connection& /*connection*/) override {
    ++looks;
    if (throws) throw std::runtime_error("not of the store");
    return over;
  }
  [[nodiscard]] Clock::time_point look_again_at() const override { return Clock::now() + pause; }
  void answer(Call& /*call*/) override {}

  void wake() const { wake_(); }

  std::atomic<int> looks{0};
  std::atomic<bool> over{false};
  std::atomic<bool> throws{false};
  std::atomic<bool> watched{true};
  std::chrono::milliseconds pause{1h};

 private:
  std::function<void()> wake_;
};

class SuspendedCallsTest : public ::testing::Test {
 protected:
  void add() {
    calls_.add(call_, connection_, [this] { ++finished_; });
  }

  Lobby lobby_{LobbyLimits{}, [](const auto&) { return true; }, [] { return std::string(); },
               nullptr};
  std::shared_ptr<Connection> connection_ = std::make_shared<Connection>(-1, "a", lobby_);
  std::shared_ptr<ProbeCall> call_ = std::make_shared<ProbeCall>();
  std::atomic<int> finished_{0};
  SuspendedCalls calls_{2};
};

TEST_F(SuspendedCallsTest, ACallIsLookedAtWhenItComesAndWhenItIsWoken) {
  add();
  ASSERT_TRUE(eventually([&] { return call_->looks == 1; }));
  call_->wake();
  ASSERT_TRUE(eventually([&] { return call_->looks == 2; }));
  EXPECT_EQ(finished_, 0);
  call_->over = true;
  call_->wake();
  ASSERT_TRUE(eventually([&] { return finished_ == 1; }));
  EXPECT_FALSE(call_->watched);
  call_->wake();
  calls_.shutdown();
  EXPECT_EQ(call_->looks, 3);
  EXPECT_EQ(finished_, 1);
}

TEST_F(SuspendedCallsTest, ACallIsLookedAtAtTimesOfItsOwn) {
  call_->pause = 1ms;
  add();
  EXPECT_TRUE(eventually([&] { return call_->looks >= 5; }));
}

TEST_F(SuspendedCallsTest, ACallWhoseLookThrowsIsOver) {
  call_->throws = true;
  add();
  EXPECT_TRUE(eventually([&] { return finished_ == 1; }));
}

TEST_F(SuspendedCallsTest, WhatIsLeftIsDroppedUnfinished) {
  add();
  ASSERT_TRUE(eventually([&] { return call_->looks == 1; }));
  calls_.shutdown();
  EXPECT_FALSE(call_->watched);
  EXPECT_EQ(finished_, 0);
  call_->wake();
}

}  // namespace
}  // namespace symcell::server::test
