#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

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

/// The thread and the process that own a bus.
class Owner {
 public:
  bool is_forked() const { return getpid() != process_; }
  void check() const {
    if (is_forked())
      throw std::runtime_error("this bus is of the parent process: connect again after a fork");
    if (std::this_thread::get_id() != thread_)
      throw std::runtime_error("this bus is of another thread: connect in each thread");
  }
  bool may_close() const { return !is_forked() && std::this_thread::get_id() == thread_; }

 private:
  const pid_t process_ = getpid();
  const std::thread::id thread_ = std::this_thread::get_id();
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
  void close() final {
    if (owner_.may_close())
      kind_.reset();
    else
      static_cast<void>(kind_.release());  // its threads are not here
  }

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
