#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "saphira/bus/node.hpp"

namespace saphira::python {

namespace py = pybind11;

/// Runs f without the interpreter's lock. (No object takes it back: a thread that outlives the
/// interpreter ends there, and must not do so in a destructor.)
template <class F>
auto unlocked(F f) {
  PyThreadState* const state = PyEval_SaveThread();
  try {
    auto result = f();
    PyEval_RestoreThread(state);
    return result;
  } catch (...) {
    PyEval_RestoreThread(state);
    throw;
  }
}

/// The calls from Python into this module that a thread is in. They use what another thread or a
/// signal's handler closes meanwhile: it ends with the outermost of them.
struct Calls {
  static const std::shared_ptr<Calls>& of_this_thread() {
    thread_local const auto own = std::make_shared<Calls>();
    return own;
  }

  int depth = 0;
  std::vector<std::shared_ptr<void>> closed;  ///< in the order of their ends
};

/// One of them.
class Call {
 public:
  Call() { ++calls_.depth; }
  ~Call() {
    // Other threads run meanwhile, and may close more.
    while (calls_.depth == 1 && !calls_.closed.empty())
      for (auto& each : std::exchange(calls_.closed, {}))
        each.reset();
    --calls_.depth;
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  Calls& calls_ = *Calls::of_this_thread();
};

/// The thread and the process that own a bus.
class Owner {
 public:
  bool is_forked() const { return getpid() != process_; }
  void check() const {
    if (is_forked())
      throw std::runtime_error("this bus is of the parent process: connect again after a fork");
    if (Calls::of_this_thread() != calls_)
      throw std::runtime_error("this bus is of another thread: connect in each thread");
  }
  /// Ends it, after the owner's call that is underway. After a fork its threads are not here: it
  /// stays.
  template <class T>
  void end(std::unique_ptr<T> own) const {
    T* const ends = own.release();
    if (ends == nullptr || is_forked())
      return;
    std::shared_ptr<void> closed(ends, [](void* each) {
      unlocked([each] {
        delete static_cast<T*>(each);
        return 0;
      });
    });
    if (calls_->depth > 0)
      calls_->closed.push_back(std::move(closed));
  }

 private:
  const pid_t process_ = getpid();
  const std::shared_ptr<Calls> calls_ = Calls::of_this_thread();
};

/// An endpoint on a bus, such as a reader. It is closed before its bus is.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  virtual void close() = 0;
};

/// An endpoint that is a `Kind`, until it is closed.
template <class Face, class Kind>
class Owned : public Face {
 public:
  Owned(const Owner& owner, std::unique_ptr<Kind> kind) : owner_(owner), kind_(std::move(kind)) {}
  ~Owned() override { close(); }
  void close() final { owner_.end(std::move(kind_)); }

  /// std::runtime_error where it may not be used.
  Kind& kind() {
    owner_.check();
    if (!kind_)
      throw std::runtime_error("the bus is closed");
    return *kind_;
  }

 private:
  const Owner owner_;
  std::unique_ptr<Kind> kind_;
};

class AnyReader : public Endpoint {
 public:
  virtual std::size_t matched() = 0;
  /// (sample, withdrawn, sender or None, age) of each that has come, oldest first.
  virtual py::list take() = 0;
};

class AnyWriter : public Endpoint {
 public:
  virtual std::size_t matched() = 0;
  virtual bool write(py::handle sample) = 0;
  virtual bool dispose(py::handle sample) = 0;
};

/// ValueError: there is no topic of this name.
std::shared_ptr<AnyReader> make_reader(const Owner& owner, bus::Node& node,
                                       const std::string& topic);
std::shared_ptr<AnyWriter> make_writer(const Owner& owner, bus::Node& node,
                                       const std::string& topic);

/// A sample as C++ has it, back in Python: for tests.
py::object there_and_back(py::handle sample);

}  // namespace saphira::python
