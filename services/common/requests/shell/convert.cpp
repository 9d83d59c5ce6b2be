#include "requests/shell/convert.hpp"

#include "geometry/shell/convert.hpp"
#include "saphira/base/enum_pairs.hpp"
#include "saphira/bus/sender.hpp"

namespace saphira {
namespace {

constexpr auto kKinds = pairs_by_name<ArgumentKind, v1::ArgumentKind>();
constexpr auto kFrames = pairs_by_name<Frame, v1::Frame>();
constexpr auto kCodes = pairs_by_name<AnswerCode, v1::AnswerCode>();

}  // namespace

ArgumentKind from_bus(v1::ArgumentKind kind) {
  return kKinds.ours(kind, ArgumentKind::unbound);
}

v1::ArgumentKind to_bus(ArgumentKind kind) {
  return kKinds.theirs(kind);
}

Frame from_bus(v1::Frame frame) {
  return kFrames.ours(frame, Frame::odom);
}

Argument from_bus(const v1::Argument& argument) {
  switch (argument.kind) {
    case v1::ARGUMENT_NUMBER:
      return {argument.name, argument.number};
    case v1::ARGUMENT_TEXT:
      return {argument.name, argument.text};
    case v1::ARGUMENT_TRUTH:
      return {argument.name, argument.number != 0.0};
    case v1::ARGUMENT_POINT:
      if (argument.frame > v1::FRAME_MAP)
        break;  // a point in an unknown frame has no place
      return {argument.name, PlacedPoint{from_bus(argument.point), from_bus(argument.frame)}};
    case v1::ARGUMENT_UNBOUND:
      break;
  }
  Argument unbound;
  unbound.name = argument.name;
  unbound.kind = ArgumentKind::unbound;
  if (argument.kind == v1::ARGUMENT_UNBOUND)
    unbound.text = argument.text;
  return unbound;
}

v1::Argument to_bus(const Argument& argument) {
  return {.name = argument.name,
          .kind = kKinds.theirs(argument.kind),
          .number = argument.number,
          .text = argument.text,
          .point = to_bus(argument.point),
          .frame = kFrames.theirs(argument.frame)};
}

Arguments from_bus(const std::vector<v1::Argument>& arguments) {
  return converted(arguments, [](const auto& each) { return from_bus(each); });
}

std::vector<v1::Argument> to_bus(const Arguments& arguments) {
  return converted(arguments, [](const auto& each) { return to_bus(each); });
}

Request from_bus(const bus::Sample<v1::Request>& sample) {
  const v1::Request& request = sample.data;
  const Checked person = bus::asker_of(sample.info, request.person);
  return {request.functor,
          from_bus(request.arguments),
          named(request.source.substr(0, 255), person),
          request.service,
          request.stamp,
          request.asker,
          request.number,
          request.deadline,
          person};
}

v1::Request to_bus(const Request& request) {
  return {.stamp = request.stamp,
          .asker = request.asker,
          .number = request.number,
          .source = request.source,
          .service = request.service,
          .functor = request.functor,
          .arguments = to_bus(request.arguments),
          .deadline = request.deadline,
          .person = bus::to_bus(request.person)};
}

Answer from_bus(const v1::Answer& answer) {
  return {kCodes.ours(answer.code, AnswerCode::lost), answer.text, from_bus(answer.results)};
}

v1::Answer to_bus(const Answer& answer) {
  return {
      .code = kCodes.theirs(answer.code), .text = answer.text, .results = to_bus(answer.results)};
}

}  // namespace saphira
