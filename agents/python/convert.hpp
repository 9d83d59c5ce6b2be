#pragma once

// Samples of the contract as the dataclasses of saphira.v1, and back: the same values, NaN,
// infinities, unnamed numbers of enums and the bytes of texts included.

#include <pybind11/pybind11.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "saphira/idl/members.hpp"

namespace saphira::python {

namespace py = pybind11;

/// A class of saphira.v1.
inline py::object class_of(const char* name) {
  return py::module_::import("saphira.v1").attr(name);
}

/// The dataclass of a struct of the contract: the names and classes of its members.
template <class T>
struct Dataclass {
  struct Field {
    py::str name;
    py::object type;
  };
  py::object type;
  std::vector<Field> fields;

  static const Dataclass& of(py::handle type) {
    // Never freed: the interpreter may be gone by the end of the process.
    static const auto* const known = new Dataclass(type);
    return *known;
  }

 private:
  explicit Dataclass(py::handle of) : type(py::reinterpret_borrow<py::object>(of)) {
    const py::object types = type.attr("__annotations__");
    const T sample{};
    visit_members(sample, [&](const Member& member, const auto&) {
      fields.push_back({py::reinterpret_steal<py::str>(PyUnicode_InternFromString(member.name)),
                        types[member.name]});
    });
  }
};

inline py::object checked(PyObject* made) {
  if (made == nullptr)
    throw py::error_already_set();
  return py::reinterpret_steal<py::object>(made);
}

template <class T>
py::object to_python(const std::vector<T>& items, py::handle type);
template <class T>
void from_python(py::handle given, std::vector<T>& items, py::handle type);

/// type: the class of the value, as in saphira.v1.
template <class T>
py::object to_python(const T& value, [[maybe_unused]] py::handle type) {
  if constexpr (std::is_same_v<T, bool>) {
    return py::bool_(value);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return checked(PyUnicode_DecodeUTF8(value.data(), static_cast<Py_ssize_t>(value.size()),
                                        "surrogateescape"));
  } else if constexpr (std::is_floating_point_v<T>) {
    return py::float_(value);
  } else if constexpr (std::is_enum_v<T>) {
    return type(static_cast<std::uint32_t>(value));
  } else if constexpr (std::is_integral_v<T>) {
    const bool plain = type.ptr() == reinterpret_cast<PyObject*>(&PyLong_Type);
    return plain ? py::int_(value) : py::object(type(value));
  } else {
    const auto& known = Dataclass<T>::of(type);
    py::tuple values(known.fields.size());
    std::size_t i = 0;
    visit_members(value, [&](const Member&, const auto& part) {
      PyTuple_SET_ITEM(values.ptr(), static_cast<Py_ssize_t>(i),
                       to_python(part, known.fields[i].type).release().ptr());
      ++i;
    });
    return known.type(*values);
  }
}
template <class T>
py::object to_python(const std::vector<T>& items, py::handle type) {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    return py::bytes(reinterpret_cast<const char*>(items.data()), items.size());
  } else {
    const py::object item_type = type.attr("__args__")[py::int_(0)];
    py::list list(items.size());
    for (std::size_t i = 0; i < items.size(); ++i)
      PyList_SET_ITEM(list.ptr(), static_cast<Py_ssize_t>(i),
                      to_python<T>(items[i], item_type).release().ptr());
    return list;
  }
}

/// A value that a member cannot have.
struct Misfit {
  std::string place;  ///< such as arguments[1].number
  std::string expected;
  std::string found;
};

[[noreturn]] inline void misfit(const std::string& expected, py::handle found) {
  throw Misfit{"", expected, py::repr(found).cast<std::string>().substr(0, 60)};
}

template <class T>
T integer(py::handle item, const std::string& expected) {
  const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(item.ptr()));
  bool good = static_cast<bool>(whole) && !PyBool_Check(item.ptr());
  T value{};
  if (good) {
    using Widest = std::conditional_t<std::is_signed_v<T>, long long, unsigned long long>;
    Widest number{};
    if constexpr (std::is_signed_v<T>)
      number = PyLong_AsLongLong(whole.ptr());
    else
      number = PyLong_AsUnsignedLongLong(whole.ptr());
    good = PyErr_Occurred() == nullptr && std::in_range<T>(number);
    value = static_cast<T>(number);
  }
  PyErr_Clear();
  if (!good)
    misfit(expected + " from " + std::to_string(std::numeric_limits<T>::min()) + " to " +
               std::to_string(std::numeric_limits<T>::max()),
           item);
  return value;
}

/// Throws Misfit.
template <class T>
void from_python(py::handle item, T& value, [[maybe_unused]] py::handle type) {
  if constexpr (std::is_same_v<T, bool>) {
    if (!PyBool_Check(item.ptr()))
      misfit("True or False", item);
    value = item.ptr() == Py_True;
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (!PyUnicode_Check(item.ptr()))
      misfit("a str", item);
    const py::object bytes =
        checked(PyUnicode_AsEncodedString(item.ptr(), "utf-8", "surrogateescape"));
    value.assign(PyBytes_AS_STRING(bytes.ptr()),
                 static_cast<std::size_t>(PyBytes_Size(bytes.ptr())));
    if (value.find('\0') != std::string::npos)
      misfit("a str without a zero character", item);
  } else if constexpr (std::is_floating_point_v<T>) {
    const double number = PyFloat_AsDouble(item.ptr());
    const bool good = PyErr_Occurred() == nullptr && !PyBool_Check(item.ptr());
    PyErr_Clear();
    value = static_cast<T>(number);
    if (!good || (std::isinf(value) && !std::isinf(number)))
      misfit(sizeof(T) == 4 ? "a number from -3.4e38 to 3.4e38" : "a number", item);
  } else if constexpr (std::is_enum_v<T>) {
    value = static_cast<T>(integer<std::uint32_t>(
        item, "one of " + py::str(type.attr("__name__")).cast<std::string>() + ", a number"));
  } else if constexpr (std::is_integral_v<T>) {
    value = integer<T>(item, "a whole number");
  } else {
    const auto& known = Dataclass<T>::of(type);
    if (!py::isinstance(item, known.type))
      misfit("a " + py::str(type.attr("__name__")).cast<std::string>(), item);
    std::size_t i = 0;
    visit_members(value, [&](const Member& member, auto& part) {
      const auto& field = known.fields[i++];
      try {
        const py::object given = item.attr(field.name);
        if constexpr (requires { part.emplace_back(); })
          if (PySequence_Check(given.ptr()) && py::len(given) > member.bound)
            throw Misfit{"", "at most " + std::to_string(member.bound),
                         std::to_string(py::len(given))};
        from_python(given, part, field.type);
      } catch (Misfit& wrong) {
        const bool deeper = !wrong.place.empty() && wrong.place.front() != '[';
        wrong.place = member.name + std::string(deeper ? "." : "") + wrong.place;
        throw;
      }
    });
  }
}
template <class T>
void from_python(py::handle given, std::vector<T>& items, py::handle type) {
  if (!PySequence_Check(given.ptr()) || PyUnicode_Check(given.ptr()))
    misfit("a list", given);
  // A tuple stays as it is, whatever the program does when its items are read.
  const py::object list = checked(PySequence_Tuple(given.ptr()));
  const bool is_bytes = std::is_same_v<T, std::uint8_t>;
  const py::object item_type =
      is_bytes ? py::object() : py::object(type.attr("__args__")[py::int_(0)]);
  const auto count = static_cast<std::size_t>(PyTuple_GET_SIZE(list.ptr()));
  items.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    T item{};
    try {
      from_python(PyTuple_GET_ITEM(list.ptr(), static_cast<Py_ssize_t>(i)), item, item_type);
    } catch (Misfit& wrong) {
      wrong.place = "[" + std::to_string(i) + "]" + (wrong.place.empty() ? "" : ".") + wrong.place;
      throw;
    }
    items[i] = std::move(item);
  }
}

/// ValueError: a member cannot have its value; names the place and what was expected.
template <class T>
T sample_of(py::handle item, const char* name) {
  T sample{};
  try {
    from_python(item, sample, class_of(name));
  } catch (const Misfit& wrong) {
    throw py::value_error(std::string(name) + (wrong.place.empty() ? "" : ".") + wrong.place +
                          ": expected " + wrong.expected + ", found " + wrong.found);
  }
  return sample;
}

}  // namespace saphira::python
