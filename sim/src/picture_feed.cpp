#include "picture_feed.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"

namespace saphira::sim {

PictureFeed::PictureFeed(Render render, std::string folder,
                         const std::optional<std::string>& socket)
    : render_(std::move(render)), folder_(std::move(folder)) {
  std::error_code error;
  if (!folder_.empty() && !std::filesystem::is_directory(folder_) &&
      !std::filesystem::create_directories(folder_, error))
    throw UnusableFile(folder_ + ": cannot be made: " + error.message());
  if (socket)
    listener_.emplace(Listener::local(*socket));
}

void PictureFeed::add_to(std::vector<pollfd>& fds) const {
  if (listener_)
    fds.push_back({listener_->fd(), POLLIN, 0});
  for (const Viewer& viewer : viewers_)
    fds.push_back({viewer.fd.get(),
                   static_cast<short>(viewer.waiting.empty() ? POLLIN : POLLIN | POLLOUT), 0});
}

// False where the viewer has gone.
bool PictureFeed::send(Viewer& viewer) {
  // Bytes from viewers are ignored, but their end is not.
  std::array<char, 256> said{};
  const ssize_t heard = ::recv(viewer.fd.get(), said.data(), said.size(), MSG_DONTWAIT);
  if (heard == 0 || (heard < 0 && errno != EAGAIN && errno != EINTR))
    return false;
  while (!viewer.waiting.empty()) {
    const ssize_t size =
        ::send(viewer.fd.get(), viewer.waiting.data(), viewer.waiting.size(), MSG_NOSIGNAL);
    if (size < 0)
      return errno == EAGAIN || errno == EINTR;
    viewer.waiting.erase(0, static_cast<std::size_t>(size));
  }
  return true;
}

void PictureFeed::write(const std::string& picture, std::uint64_t cycle) const {
  const std::string name = folder_ + format("/%06llu.pgm", static_cast<unsigned long long>(cycle));
  std::ofstream file(name, std::ios::binary);
  file << picture << std::flush;
  if (!file)
    throw std::runtime_error(cannot_be(name, "written"));
}

void PictureFeed::serve(const Scene& scene, RobotNumber robot, double head, std::uint64_t cycle,
                        std::size_t waiting) {
  if (listener_)
    for (Fd fd = listener_->accept(); fd; fd = listener_->accept())
      viewers_.push_back(
          {std::move(fd), std::accumulate(before_.begin(), before_.end(), std::string())});
  const bool is_kept = listener_ && waiting > 1;
  if (cycle != cycle_ && cycle != 0 && (!folder_.empty() || !viewers_.empty() || is_kept)) {
    const std::string picture = render_(scene, robot, head, cycle);
    for (Viewer& viewer : viewers_)
      if (viewer.waiting.size() <= (waiting - 1) * picture.size())
        viewer.waiting += picture;
    if (!folder_.empty())
      write(picture, cycle);
    if (is_kept)
      before_.push_back(picture);
    if (before_.size() > waiting)
      before_.pop_front();
  }
  cycle_ = cycle;
  std::erase_if(viewers_, [](Viewer& viewer) { return !send(viewer); });
}

PictureFeed::Render stereo_pairs(std::uint64_t seed) {
  return [seed](const Scene& scene, RobotNumber robot, double head, std::uint64_t cycle) {
    StereoRig rig;
    rig.pose_in_robot.th = head;
    Random random(seed, cycle);
    return to_pgm(render_stereo(scene, robot, rig, random), rig, cycle);
  };
}

PictureFeed::Render color_pictures() {
  return [](const Scene& scene, RobotNumber robot, double head, std::uint64_t cycle) {
    PinholeCamera camera;
    camera.pose_in_robot.th = head;
    camera.noise = 0.0;  // it would be most of a compressed picture
    camera.texture = 0.25;
    Random random(0, 0);
    return to_ppm(render_picture(scene, robot, camera, random), camera, cycle);
  };
}

}  // namespace saphira::sim
