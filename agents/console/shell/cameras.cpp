#include "cameras.hpp"

#include <algorithm>
#include <exception>

#include "saphira/base/format.hpp"
#include "saphira/camera/frame.hpp"
#include "saphira/console/board.hpp"

namespace saphira::console {

namespace {

constexpr std::size_t kCycles = 50;  // pictures are younger

/// The picture in another quality. One that cannot be read goes as it is: the page says so.
std::vector<std::uint8_t> in_quality(const std::vector<std::uint8_t>& jpeg, int quality) {
  try {
    return camera::to_jpeg(camera::from_jpeg(jpeg), quality);
  } catch (const std::exception&) {
    return jpeg;
  }
}

}  // namespace

void Cameras::set_watched(bool any) {
  if (any == reader_.has_value())
    return;
  picture_.reset();
  if (any)
    reader_.emplace(node_.reader(bus::topics::kCameraPictures));
  else
    reader_.reset();
}

void Cameras::heard(std::uint64_t cycle, double now) {
  if (!cycles_.empty() && cycles_.back().first == cycle)
    return;
  cycles_.emplace_back(cycle, now);
  if (cycles_.size() > kCycles)
    cycles_.pop_front();
}

bool Cameras::poll(double now) {
  auto newest = reader_ ? reader_->take_newest() : std::nullopt;
  if (!newest)
    return false;
  picture_ = std::move(newest);
  ++number_;
  came_ = now;
  return true;
}

double Cameras::captured() const {
  for (const auto& [cycle, at] : cycles_)
    if (cycle == picture_->stamp.cycle)
      return std::min(came_, at + picture_->delay);
  return came_;
}

std::optional<std::string> Cameras::next(PictureFlow& flow, PictureFlow::Lane lane,
                                         double now) const {
  if (!picture_ || !flow.takes(lane, number_, now))
    return std::nullopt;
  flow.sent(lane, number_, now);
  const v1::CameraPicture& picture = *picture_;
  const int quality = flow.quality();
  const std::vector<std::uint8_t> smaller =
      quality == 0 ? std::vector<std::uint8_t>() : in_quality(picture.jpeg, quality);
  const std::vector<std::uint8_t>& jpeg = quality == 0 ? picture.jpeg : smaller;
  std::string text = format(
      "{\"number\":%llu,\"camera\":%s,\"cycle\":%llu,\"now\":%.4f,\"age\":%.4f,"
      "\"columns\":%u,\"rows\":%u,\"field\":%.5f,\"x\":%.4f,\"y\":%.4f,\"th\":%.5f,\"height\":%.4f,"
      "\"tilt\":%.5f}\n",
      static_cast<unsigned long long>(number_), quoted(picture.camera).c_str(),
      static_cast<unsigned long long>(picture.stamp.cycle), now, std::max(0.0, now - captured()),
      picture.columns, picture.rows, picture.field_of_view, picture.pose_in_robot.x,
      picture.pose_in_robot.y, picture.pose_in_robot.th, picture.height, picture.tilt);
  return text.append(jpeg.begin(), jpeg.end());
}

}  // namespace saphira::console
