#include "endpoints.hpp"

#include <string_view>

#include "convert.hpp"

namespace saphira::python {
namespace {

template <class T>
const char* short_name() {
  const std::string_view whole = bus::type_of<T>().name;
  return whole.substr(whole.rfind(':') + 1).data();
}

template <class T>
py::object python_of(const T& sample) {
  return to_python(sample, class_of(short_name<T>()));
}

/// The part that both kinds have.
template <class Face, class Kind>
class Typed : public Owned<Face, Kind> {
 public:
  Typed(const Owner& owner, Kind kind)
      : Owned<Face, Kind>(owner, std::make_unique<Kind>(std::move(kind))) {}
  std::size_t matched() override { return this->kind().matched(); }
};

template <class T>
class TypedReader final : public Typed<AnyReader, bus::Reader<T>> {
 public:
  using Typed<AnyReader, bus::Reader<T>>::Typed;
  py::list take() override {
    py::list list;
    for (const bus::Sample<T>& sample : this->kind().take())
      list.append(py::make_tuple(python_of(sample.data), sample.info.disposed,
                                 sample.info.sender
                                     ? py::object(py::str(sample.info.sender->text()))
                                     : py::object(py::none()),
                                 sample.info.age));
    return list;
  }
};

template <class T>
class TypedWriter final : public Typed<AnyWriter, bus::Writer<T>> {
 public:
  using Typed<AnyWriter, bus::Writer<T>>::Typed;
  bool write(py::handle item) override {
    auto& writer = this->kind();
    const T sample = sample_of<T>(item, short_name<T>());
    return unlocked([&] { return writer.write(sample); });
  }
  bool dispose(py::handle item) override {
    auto& writer = this->kind();
    const T sample = sample_of<T>(item, short_name<T>());
    return unlocked([&] { return writer.dispose(sample); });
  }
};

template <class Face, class Make>
std::shared_ptr<Face> make(const std::string& topic, const Make& make_typed) {
  std::shared_ptr<Face> made;
  bus::for_each_topic([&]<class T>(const bus::Topic<T>& known) {
    if (topic == known.name)
      made = make_typed(known);
  });
  if (!made)
    throw py::value_error("no topic \"" + topic + "\": saphira.topics has them");
  return made;
}

}  // namespace

std::shared_ptr<AnyReader> make_reader(const Owner& owner, bus::Node& node,
                                       const std::string& topic) {
  return make<AnyReader>(topic, [&]<class T>(const bus::Topic<T>& known) {
    return std::make_shared<TypedReader<T>>(owner, node.reader(known));
  });
}

std::shared_ptr<AnyWriter> make_writer(const Owner& owner, bus::Node& node,
                                       const std::string& topic) {
  return make<AnyWriter>(topic, [&]<class T>(const bus::Topic<T>& known) {
    return std::make_shared<TypedWriter<T>>(owner, node.writer(known));
  });
}

py::object there_and_back(py::handle sample) {
  py::object back = py::none();
  const auto name = py::str(py::type::handle_of(sample).attr("__name__")).cast<std::string>();
#define SAPHIRA_TYPE(T) \
  if (name == #T)       \
    back = python_of(sample_of<v1::T>(sample, #T));
#include "saphira/idl/topic_types.def"
  return back;
}

}  // namespace saphira::python
