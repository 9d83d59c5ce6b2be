#include "feeds.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <utility>

#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"

namespace saphira::sim {
namespace {

constexpr std::size_t kMostViewers = 16;       // of the view
constexpr std::size_t kLongest = 4096;         // of an incoming line
constexpr std::size_t kMostWaiting = 1 << 20;  // [bytes] that a viewer has not read
constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();  // to send

bool passes() {
  return errno == EAGAIN || errno == EINTR;
}

// False where the viewer has gone, or says too much.
bool receive(Viewers::Viewer& viewer, std::size_t most) {
  std::array<char, 2048> part{};
  for (;;) {
    const ssize_t size = ::recv(viewer.fd, part.data(), part.size(), MSG_DONTWAIT);
    if (size == 0 || viewer.said.size() > most)
      return false;
    if (size < 0)
      return passes();
    viewer.said.append(part.data(), static_cast<std::size_t>(size));
  }
}

// False where the viewer has gone, or reads too little.
bool send(Viewers::Viewer& viewer, std::size_t most) {
  while (!viewer.waiting.empty()) {
    const ssize_t size =
        ::send(viewer.fd, viewer.waiting.data(), viewer.waiting.size(), MSG_NOSIGNAL);
    if (size < 0)
      return passes() && viewer.waiting.size() < most;
    viewer.waiting.erase(0, static_cast<std::size_t>(size));
  }
  return true;
}

}  // namespace

void Viewers::add_to(std::vector<pollfd>& fds) const {
  fds.push_back({listener_.fd(), POLLIN, 0});
  for (const Viewer& viewer : all)
    fds.push_back(
        {viewer.fd, static_cast<short>(viewer.waiting.empty() ? POLLIN : POLLIN | POLLOUT), 0});
}

bool Viewers::accept(const std::function<std::string()>& first, std::size_t most) {
  const std::size_t before = all.size();
  for (Descriptor fd = listener_.accept(); fd && all.size() < most; fd = listener_.accept())
    all.push_back({std::move(fd), first()});
  return all.size() > before;
}

void Viewers::serve(const std::function<void(Viewer& viewer)>& heard, std::size_t most_said,
                    std::size_t most_waiting) {
  std::erase_if(all, [&](Viewer& viewer) {
    const bool there = receive(viewer, most_said);
    heard(viewer);
    return !there || !send(viewer, most_waiting);
  });
}

PictureFeed::PictureFeed(Render render, std::string folder,
                         const std::optional<std::string>& socket, std::size_t in_step)
    : render_(std::move(render)), folder_(std::move(folder)), in_step_(in_step) {
  std::error_code error;
  if (!folder_.empty() && !std::filesystem::is_directory(folder_) &&
      !std::filesystem::create_directories(folder_, error))
    throw UnusableFile(folder_ + ": cannot be made: " + error.message());
  if (socket)
    viewers_.emplace(*socket);
}

void PictureFeed::add_to(std::vector<pollfd>& fds) const {
  if (viewers_)
    viewers_->add_to(fds);
}

void PictureFeed::write(const std::string& picture, std::uint64_t cycle) const {
  const std::string name = folder_ + format("/%06llu.pgm", static_cast<unsigned long long>(cycle));
  std::ofstream file(name, std::ios::binary);
  file << picture << std::flush;
  if (!file)
    throw std::runtime_error(cannot_be(name, "written"));
}

void PictureFeed::serve(const Scene& scene, RobotNumber robot, double head, std::uint64_t cycle,
                        bool single_step) {
  const std::size_t waiting = single_step ? in_step_ : 1;
  if (viewers_)
    viewers_->accept([this] { return joined(before_, ""); }, kAny);
  const bool is_kept = viewers_ && waiting > 1;
  const bool is_watched = viewers_ && !viewers_->all.empty();
  if (cycle != cycle_ && cycle != 0 && (!folder_.empty() || is_watched || is_kept)) {
    const std::string picture = render_(scene, robot, head, cycle);
    if (viewers_)
      for (Viewers::Viewer& viewer : viewers_->all)
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
  if (viewers_)  // bytes from viewers are ignored, but their end is not
    viewers_->serve([](Viewers::Viewer& viewer) { viewer.said.clear(); }, kLongest, kAny);
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

bool ViewFeed::serve(const std::function<std::string()>& world,
                     const std::function<std::string(const std::string&)>& obey) {
  bool any = viewers_.accept(world, kMostViewers);
  const auto heard = [&](Viewers::Viewer& viewer) {
    for (std::size_t end = viewer.said.find('\n'); end != std::string::npos;
         end = viewer.said.find('\n')) {
      viewer.waiting += obey(viewer.said.substr(0, end));
      viewer.said.erase(0, end + 1);
      any = true;
    }
  };
  viewers_.serve(heard, kLongest, kMostWaiting);
  return any;
}

void ViewFeed::tell(const std::string& line, bool must) {
  for (Viewers::Viewer& viewer : viewers_.all)
    if (must || viewer.waiting.empty()) {
      viewer.waiting += line;
      send(viewer, kMostWaiting);
    }
}

}  // namespace saphira::sim
