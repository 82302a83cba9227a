// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The functions of libc++ that a library without threads lacks, for its one thread. A thread runs to
// its end where it begins. A wait for another thread traps; a pause is none. An exception traps, as the module has
// none.
#include <condition_variable>
#include <mutex>
#include <shared_mutex>
#include <thread>

#include "dermis/learn/calibration/parallel.hpp"

_LIBCPP_BEGIN_NAMESPACE_STD

mutex::~mutex() noexcept = default;
void mutex::lock() {}
bool mutex::try_lock() noexcept {
  return true;
}
void mutex::unlock() noexcept {}

condition_variable::~condition_variable() = default;
void condition_variable::notify_one() noexcept {}
void condition_variable::notify_all() noexcept {}
void condition_variable::wait(unique_lock<mutex>&) noexcept {
  __builtin_trap();
}
void condition_variable::__do_timed_wait(unique_lock<mutex>&,
                                         chrono::time_point<chrono::system_clock, chrono::nanoseconds>) noexcept {
  __builtin_trap();
}

__shared_mutex_base::__shared_mutex_base() = default;
void __shared_mutex_base::lock() {}
bool __shared_mutex_base::try_lock() {
  return true;
}
void __shared_mutex_base::unlock() {}
void __shared_mutex_base::lock_shared() {}
bool __shared_mutex_base::try_lock_shared() {
  return true;
}
void __shared_mutex_base::unlock_shared() {}

thread::~thread() = default;
void thread::join() {
  __t_ = _LIBCPP_NULL_THREAD;
}
void thread::detach() {
  __t_ = _LIBCPP_NULL_THREAD;
}
__thread_specific_ptr<__thread_struct>& __thread_local_data() {
  static __thread_specific_ptr<__thread_struct> data;
  return data;
}
__thread_struct::__thread_struct() : __p_(nullptr) {}
__thread_struct::~__thread_struct() = default;
unsigned thread::hardware_concurrency() noexcept {
  return 1;
}
void this_thread::sleep_for(const chrono::nanoseconds&) {}

_LIBCPP_END_NAMESPACE_STD

extern "C" {
void* __cxa_allocate_exception(std::size_t) {
  __builtin_trap();
}
void __cxa_throw(void*, void*, void (*)(void*)) {
  __builtin_trap();
}
int __cxa_atexit(void (*destroy)(void*), void* object, void* library);
/// The one thread ends with the program.
int __cxa_thread_atexit(void (*destroy)(void*), void* object, void* library) {
  return __cxa_atexit(destroy, object, library);
}
}

namespace dermis::learn::calibration {

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  for (std::size_t k = 0; k < count; ++k) body(k);
}

}  // namespace dermis::learn::calibration
