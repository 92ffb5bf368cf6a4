#include "core/runtime/guarded_thread.hpp"

#include <array>
#include <future>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>

namespace fvd {
namespace {

std::string text_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    return error.what();
  }
}

TEST(GuardedThread, HasItsName) {
  std::promise<std::string> name;
  const auto thread = start_thread("fvd-test", [&](std::stop_token) {
    std::array<char, 16> text{};
    pthread_getname_np(pthread_self(), text.data(), text.size());
    name.set_value(text.data());
  });
  EXPECT_EQ(name.get_future().get(), "fvd-test");
}

TEST(GuardedThread, TellsItsOwnerOfAnException) {
  std::promise<std::string> told;
  const auto thread = start_thread(
      "fvd-test", [](std::stop_token) { throw std::runtime_error("no more"); },
      [&](std::string_view name, std::exception_ptr failure) {
        told.set_value(std::string(name) + ": " + text_of(failure));
      });
  EXPECT_EQ(told.get_future().get(), "fvd-test: no more");
}

TEST(GuardedThread, TellsTheProcessWhereItsOwnerDoesNotCare) {
  std::promise<std::string> told;
  set_thread_failure_handler([&](std::string_view, std::exception_ptr failure) { told.set_value(text_of(failure)); });
  const auto thread = start_thread("fvd-test", [](std::stop_token) { throw std::runtime_error("no more"); });
  EXPECT_EQ(told.get_future().get(), "no more");
  set_thread_failure_handler({});
}

TEST(GuardedThreadDeathTest, EndsTheProgramWhereNobodyCares) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto fail = [] {
    start_thread("fvd-test", [](std::stop_token) { throw std::runtime_error("no more"); }).join();
  };
  EXPECT_DEATH(fail(), "thread fvd-test ended by an exception: no more");
}

TEST(GuardedThread, StopsWhenItsHandleGoes) {
  std::promise<void> stopped;
  auto ended = stopped.get_future();
  {
    const auto thread = start_thread("fvd-test", [&](const std::stop_token& stop) {
      const std::stop_callback tell(stop, [&] { stopped.set_value(); });
      ended.wait();
    });
  }
  EXPECT_EQ(ended.wait_for(std::chrono::seconds(0)), std::future_status::ready);
}

}  // namespace
}  // namespace fvd
