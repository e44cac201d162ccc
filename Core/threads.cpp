// SPDX-FileCopyrightText: Copyright (c) 2026 The Undecimate authors
// SPDX-License-Identifier: BSD-3-Clause

#include "threads.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace undecimate
{

struct Threads::Internals
{
  std::vector<std::thread> others;

  std::mutex mutex; // of all below but `next`
  std::condition_variable begun;
  std::condition_variable ended;
  std::uint64_t turn = 0; // of calls of run()
  int working = 0;        // of the others
  bool leaving = false;
  const Job* job = nullptr;
  Index jobCount = 0;
  std::exception_ptr failure;

  std::atomic<Index> next{ 0 };

  void work(int thread)
  {
    try
    {
      for (Index i = this->next++; i < this->jobCount; i = this->next++)
      {
        (*this->job)(i, thread);
      }
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(this->mutex);
      if (!this->failure)
      {
        this->failure = std::current_exception();
      }
      this->next = this->jobCount;
    }
  }

  void serve(int thread)
  {
    std::uint64_t seen = 0;
    for (;;)
    {
      {
        std::unique_lock<std::mutex> lock(this->mutex);
        this->begun.wait(lock, [&] { return this->leaving || this->turn != seen; });
        if (this->leaving)
        {
          return;
        }
        seen = this->turn;
      }
      this->work(thread);
      const std::lock_guard<std::mutex> lock(this->mutex);
      if (--this->working == 0)
      {
        this->ended.notify_one();
      }
    }
  }
};

Threads::Threads(int count)
  : internals_(std::make_unique<Internals>())
{
  if (count <= 0)
  {
    count = static_cast<int>(std::thread::hardware_concurrency()); // 0 if it is not known
  }
  Internals& in = *this->internals_;
  try
  {
    for (int thread = 1; thread < std::min(count, kMaximumThreads); ++thread)
    {
      in.others.emplace_back([&in, thread] { in.serve(thread); });
    }
  }
  catch (const std::system_error&)
  {
    // Those that are there do.
  }
}

Threads::~Threads()
{
  Internals& in = *this->internals_;
  {
    const std::lock_guard<std::mutex> lock(in.mutex);
    in.leaving = true;
  }
  in.begun.notify_all();
  for (std::thread& thread : in.others)
  {
    thread.join();
  }
}

int Threads::count() const
{
  return 1 + static_cast<int>(this->internals_->others.size());
}

void Threads::run(Index jobCount, const Job& job)
{
  Internals& in = *this->internals_;
  {
    const std::lock_guard<std::mutex> lock(in.mutex);
    in.job = &job;
    in.jobCount = jobCount;
    in.next = 0;
    in.failure = nullptr;
    in.working = static_cast<int>(in.others.size());
    ++in.turn;
  }
  in.begun.notify_all();
  in.work(0);
  std::exception_ptr failure;
  {
    std::unique_lock<std::mutex> lock(in.mutex);
    in.ended.wait(lock, [&] { return in.working == 0; });
    std::swap(failure, in.failure);
  }
  if (failure)
  {
    std::rethrow_exception(failure);
  }
}

} // namespace undecimate
