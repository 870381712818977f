#include "core/parallel.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace colod;

TEST_CASE("every index runs once, nested loops too, for any number of threads") {
  for (const int threads : {1, 2, 0}) {
    limit_threads(threads);
    std::vector<std::atomic<int>> count(1000);
    parallel_for(10, [&](std::size_t i) {
      parallel_ranges(100, 7, [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) ++count[i * 100 + j];
      });
    });
    for (const auto& c : count) CHECK(c == 1);
  }
}

TEST_CASE("an exception of a body reaches the caller, and nothing to do is nothing done") {
  CHECK_THROWS_AS(parallel_for(100,
                               [](std::size_t i) {
                                 if (i == 50) throw std::runtime_error("x");
                               }),
                  std::runtime_error);
  CHECK_NOTHROW(parallel_for(0, [](std::size_t) { throw std::runtime_error("x"); }));
}

TEST_CASE("an exception of one body lets the loops within the others end") {
  limit_threads(2);
  std::atomic<bool> is_begun = false, is_thrown = false;
  std::atomic<int> cut_short = 0;
  const auto wait_for = [](const std::atomic<bool>& flag) {  // no longer where one thread has both
    for (int ms = 0; !flag && ms < 2000; ++ms)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  CHECK_THROWS_AS(parallel_for(2,
                               [&](std::size_t i) {
                                 if (i == 0) {
                                   wait_for(is_begun);
                                   is_thrown = true;
                                   throw std::runtime_error("x");
                                 }
                                 is_begun = true;
                                 wait_for(is_thrown);
                                 for (int round = 0; round < 50; ++round) {
                                   std::atomic<int> count = 0;
                                   parallel_for(100, [&](std::size_t) { ++count; });
                                   cut_short += count != 100;
                                   std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                 }
                               }),
                  std::runtime_error);
  CHECK(cut_short == 0);
  limit_threads(0);
}

TEST_CASE("a limit of one's own holds inside of it only") {
  const int before = thread_count();
  for (const int threads : {1, 2}) {
    in_threads(threads, [&] {
      CHECK(thread_count() <= threads);
      std::atomic<int> count = 0;
      parallel_for(100, [&](std::size_t) { ++count; });
      CHECK(count == 100);
    });
    CHECK(thread_count() == before);
  }
  in_threads(0, [&] { CHECK(thread_count() == before); });
  CHECK_THROWS_AS(in_threads(1, [] { throw std::runtime_error("x"); }), std::runtime_error);
}
