#include "saphira/interpretation/side_view.hpp"

#include <algorithm>

namespace saphira::interpretation {
namespace {

/// Closer echoes give too little of a line's heading [m].
constexpr double kPair = 0.3;
constexpr double kPairMost = 2.5;
/// Searches among so many of the newest echoes without a line.
constexpr std::size_t kSeek = 40;
/// An established line is kept with so many echoes.
constexpr std::size_t kFew = 4;
/// A single echo or silence among others counts as an error.
constexpr std::size_t kStretch = 3;
/// A wall is bent where so many neighbouring echoes agree.
constexpr std::size_t kBent = 4;
/// Between readings farther apart than this the wall is unseen [m].
constexpr double kUnseen = 0.45;
/// The wall beside an opening [m].
constexpr double kBeside = 0.8;
/// The distance of a post's echoes from the apparent end of the wall [m]...
constexpr double kPostNear = 0.2;
/// ...and their distance from each other [m].
constexpr double kPostAgree = 0.06;
/// The time of the post's echoes before or after, by travel [m] and turns [rad].
constexpr double kPostWay = 4.0;
constexpr double kPostTurn = 0.6;

enum class Says { wall, back, through, other };

struct Event {
  double u = 0.0;
  const Return* firing = nullptr;
  Says says = Says::other;
};

double length(const std::vector<const Return*>& echoes, const Line& line) {
  return echoes.size() < 2 ? 0.0 : line.u(echoes.back()->sonar) - line.u(echoes.front()->sonar);
}

}  // namespace

Stretch straight_part(const Line& line, const Stretch& stretch, const SideSettings& settings) {
  const auto& echoes = stretch.echoes;
  const bool newest_last = echoes.back()->travelled >= echoes.front()->travelled;
  const auto at = [&](std::size_t i) { return echoes[newest_last ? echoes.size() - 1 - i : i]; };
  for (std::size_t i = 0; i + kBent <= echoes.size(); ++i) {
    double off = 0.0;
    for (std::size_t k = i; k < i + kBent; ++k)
      off += line.distance(at(k)->sonar) - at(k)->range;
    if (std::abs(off) <= kBent * settings.max_bend)
      continue;
    Stretch out = stretch;
    End& end = newest_last ? out.from : out.to;
    if (newest_last)
      out.echoes.erase(out.echoes.begin(), out.echoes.end() - static_cast<long>(i));
    else
      out.echoes.resize(i);
    end = {};
    if (i > 0) {
      end.u = line.u(at(i - 1)->sonar);
      end.sigma = line.distance(at(i - 1)->sonar) * std::tan(settings.corner_cone);
    }
    return out;
  }
  return stretch;
}

bool SideView::add(const Return& firing) {
  for (auto it = returns_.rbegin(); it != returns_.rend(); ++it) {
    if (it->id.sonar != firing.id.sonar)
      continue;
    if ((it->sonar - firing.sonar).norm() < settings_.step &&
        it->axis.dot(firing.axis) > std::cos(settings_.turn))
      return false;
    break;
  }
  returns_.push_back(firing);
  return true;
}

void SideView::clear() {
  returns_.clear();
  lines_.clear();
  walls_.clear();
}

std::optional<double> SideView::misses(const Return& firing, const Line& line, double newest,
                                       double turned) const {
  if (!firing.echo || firing.range > settings_.max_range ||
      firing.axis.dot(line.normal) < incidence_)
    return std::nullopt;
  const double off = std::abs(line.distance(firing.sonar) - firing.range);
  const double way = newest - firing.travelled;
  const double strayed =
      way * std::sqrt(settings_.error.heading_variance(way, std::max(0.0, turned - firing.turned)));
  if (off >= settings_.gate + settings_.relative_gate * firing.range + strayed)
    return std::nullopt;
  return off;
}

// Longer than one corner, which is heard at nearly the same range over its whole cone.
bool SideView::is_wall(const Candidate& candidate) const {
  const Line& line = candidate.fit.line;
  std::size_t first = 0;
  for (std::size_t i = 0; i < candidate.echoes.size(); ++i) {
    if (i > first && line.u(candidate.echoes[i]->sonar) - line.u(candidate.echoes[i - 1]->sonar) >
                         settings_.run_gap)
      first = i;
    const double run = line.u(candidate.echoes[i]->sonar) - line.u(candidate.echoes[first]->sonar);
    const double corner = 2.0 * candidate.echoes[i]->range * std::tan(settings_.corner_cone);
    if (i - first + 1 >= static_cast<std::size_t>(settings_.min_echoes) &&
        run >= settings_.min_length + corner && candidate.fit.rms <= settings_.max_rms)
      return true;
  }
  return false;
}

// Assigns every echo to its nearest line, and every line to its echoes.
void SideView::assign() {
  for (int round = 0; round < 2; ++round) {
    for (Candidate& line : lines_)
      line.echoes.clear();
    for (Return& firing : returns_) {
      Candidate* best = nullptr;
      double least = 0.0;
      for (Candidate& line : lines_) {
        const auto off = misses(firing, line.fit.line, line.newest, line.turned);
        if (off && (!best || *off < least)) {
          best = &line;
          least = *off;
        }
      }
      firing.line = best ? best->id : 0;
      if (best)
        best->echoes.push_back(&firing);
    }
    for (Candidate& candidate : lines_) {
      const Line& line = candidate.fit.line;
      if (!candidate.echoes.empty()) {
        candidate.newest = candidate.echoes.back()->travelled;
        candidate.turned = candidate.echoes.back()->turned;
      }
      std::stable_sort(
          candidate.echoes.begin(), candidate.echoes.end(),
          [&](const Return* a, const Return* b) { return line.u(a->sonar) < line.u(b->sonar); });
      if (candidate.echoes.size() >= static_cast<std::size_t>(settings_.min_echoes) &&
          length(candidate.echoes, line) >= settings_.min_length)
        candidate.fit = fit_line(candidate.echoes, line, settings_.error);
    }
  }
}

// A new line through the newest echo, if that has none.
void SideView::seek() {
  std::vector<const Return*> loose;
  for (auto it = returns_.rbegin(); it != returns_.rend() && loose.size() < kSeek; ++it) {
    if (!it->echo || it->range > settings_.max_range)
      continue;
    const bool taken = std::any_of(lines_.begin(), lines_.end(), [&](const Candidate& line) {
      return misses(*it, line.fit.line, line.newest, line.turned).has_value();
    });
    if (!taken)
      loose.push_back(&*it);
    else if (loose.empty())
      return;
  }
  if (loose.size() < static_cast<std::size_t>(settings_.min_echoes))
    return;
  Candidate best;
  std::vector<const Return*> echoes;
  for (std::size_t i = 1; i < loose.size(); ++i) {
    const double apart = (loose[i]->sonar - loose[0]->sonar).norm();
    if (apart < kPair || apart > kPairMost)
      continue;
    const auto line = tangent(*loose[0], *loose[i]);
    if (!line)
      continue;
    echoes.clear();
    for (const Return* echo : loose)
      if (misses(*echo, *line, loose.front()->travelled, loose.front()->turned))
        echoes.push_back(echo);
    if (echoes.size() > best.echoes.size()) {
      best.fit.line = *line;
      best.echoes.swap(echoes);
    }
  }
  if (best.echoes.size() < static_cast<std::size_t>(settings_.min_echoes))
    return;
  best.newest = loose.front()->travelled;
  best.turned = loose.front()->turned;
  best.fit = fit_line(best.echoes, best.fit.line, settings_.error);
  const Line& line = best.fit.line;
  std::stable_sort(best.echoes.begin(), best.echoes.end(), [&](const Return* a, const Return* b) {
    return line.u(a->sonar) < line.u(b->sonar);
  });
  if (!is_wall(best))
    return;
  best.id = ++last_line_;
  lines_.push_back(best);
  assign();
}

void SideView::interpret(double travelled, const std::deque<Return>& others) {
  while (!returns_.empty() && travelled - returns_.front().travelled > settings_.aperture)
    returns_.pop_front();
  walls_.clear();
  assign();
  std::erase_if(lines_, [](const Candidate& line) { return line.echoes.size() < kFew; });
  seek();
  for (const Candidate& line : lines_)
    if (line.echoes.size() >= kFew)
      describe(line, others);
}

void SideView::describe(const Candidate& candidate, const std::deque<Return>& others) {
  const Line& line = candidate.fit.line;
  std::vector<Event> events;
  const double square_on = std::cos(settings_.sure);
  for (const Return& firing : returns_) {
    const double d = line.distance(firing.sonar);
    const double cosine = firing.axis.dot(line.normal);
    if (d <= 0.0 || d > settings_.max_range || cosine < incidence_)
      continue;
    Event event{line.u(firing.sonar), &firing, Says::other};
    const bool sure = firing.steady && cosine >= square_on;
    if (misses(firing, line, candidate.newest, candidate.turned))
      event.says = Says::wall;
    else if (!firing.echo || firing.range > d + settings_.through) {
      if (!sure)
        continue;
      event.says = Says::through;
    } else if (sure && firing.range > d + settings_.min_back - settings_.back_agree &&
               firing.range < d + settings_.max_back + settings_.back_agree) {
      event.says = Says::back;
    }
    events.push_back(event);
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.u < b.u; });

  // Stretches as ranges of events: from an echo to an echo, without a hole.
  struct Range {
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t echoes = 0;
  };
  std::vector<Range> ranges;
  std::size_t gone = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events[i].says != Says::wall) {
      gone += events[i].says == Says::through ? 1 : 0;
      continue;
    }
    if (!ranges.empty() && gone < 2 &&
        events[i].u - events[ranges.back().last].u < settings_.run_gap) {
      ranges.back().last = i;
      ++ranges.back().echoes;
    } else {
      ranges.push_back({i, i, 1});
    }
    gone = 0;
  }
  std::erase_if(ranges, [](const Range& range) { return range.echoes < kStretch; });
  if (ranges.empty())
    return;

  Wall wall;
  wall.line = candidate.id;
  wall.fit = candidate.fit;
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    Stretch stretch;
    std::size_t own = 0;
    for (std::size_t i = ranges[k].first; i <= ranges[k].last; ++i)
      if (events[i].says == Says::wall) {
        stretch.echoes.push_back(events[i].firing);
        own += events[i].firing->line == candidate.id ? 1 : 0;
      }
    stretch.own = 2 * own >= stretch.echoes.size();
    std::vector<const Return*> beyond;
    const std::size_t end = k + 1 < ranges.size() ? ranges[k + 1].first : events.size();
    for (std::size_t i = ranges[k].last + 1; i < end; ++i)
      if (events[i].says == Says::through)
        beyond.push_back(events[i].firing);
    place_end(line, stretch, true, beyond, others, stretch.to);
    beyond.clear();
    const std::size_t begin = k > 0 ? ranges[k - 1].last + 1 : 0;
    for (std::size_t i = ranges[k].first; i > begin; --i)
      if (events[i - 1].says == Says::through)
        beyond.push_back(events[i - 1].firing);
    place_end(line, stretch, false, beyond, others, stretch.from);
    wall.stretches.push_back(std::move(stretch));
  }
  // A stretch must be longer than one corner.
  const auto is_more = [&](const Stretch& stretch) {
    return length(stretch.echoes, line) >
           2.0 * stretch.echoes.front()->range * std::tan(settings_.corner_cone) + 0.1;
  };
  // The wall beside the opening must lie on the line: the fronts of a sofa and a shelf are no wall.
  const auto off = [&](const Stretch& stretch, double end) {
    double sum = 0.0;
    double count = 0.0;
    for (const Return* echo : stretch.echoes)
      if (std::abs(line.u(echo->sonar) - end) < kBeside) {
        sum += line.distance(echo->sonar) - echo->range;
        ++count;
      }
    return sum / std::max(1.0, count);
  };
  for (std::size_t k = 0; k + 1 < ranges.size(); ++k) {
    const Stretch& before = wall.stretches[k];
    const Stretch& after = wall.stretches[k + 1];
    Opening opening{k, k + 1, before.to, after.from, {}, 0.0};
    Opening recess = opening;
    std::size_t other = 0;
    double widest = 0.0;
    double last = events[ranges[k].last].u;
    for (std::size_t i = ranges[k].last + 1; i <= ranges[k + 1].first; ++i) {
      widest = std::max(widest, events[i].u - last);
      last = events[i].u;
      if (events[i].says == Says::through)
        opening.through.push_back(events[i].firing);
      else if (events[i].says == Says::back)
        recess.through.push_back(events[i].firing);
      else if (i < ranges[k + 1].first)
        ++other;
    }
    if (widest >= kUnseen || !is_more(before) || !is_more(after) ||
        std::abs(off(before, before.to.u) - off(after, after.from.u)) > settings_.max_step)
      continue;
    if (opening.through.size() >= static_cast<std::size_t>(settings_.min_through) &&
        4 * (other + recess.through.size()) <= opening.through.size() && opening.from.open &&
        opening.to.open) {
      wall.openings.push_back(std::move(opening));
      continue;
    }
    if (find_way_in(line, before, after, recess.through, other, others, opening)) {
      wall.openings.push_back(std::move(opening));
      continue;
    }
    if (!has_door_in(line, recess, other + opening.through.size()))
      continue;
    const std::vector<const Return*> backwards(recess.through.rbegin(), recess.through.rend());
    recess.from = recess.to = {};
    place_end(line, before, true, recess.through, others, recess.from);
    place_end(line, after, false, backwards, others, recess.to);
    if (recess.from.open && recess.to.open)
      wall.openings.push_back(std::move(recess));
  }
  walls_.push_back(std::move(wall));
}

/// True where the echoes behind the line are flat, and deep enough to be a closed door in its
/// frame. others: other readings there.
bool SideView::has_door_in(const Line& line, Opening& opening, std::size_t others) const {
  const auto& echoes = opening.through;
  if (echoes.size() < static_cast<std::size_t>(settings_.min_back_echoes) ||
      4 * others > echoes.size())
    return false;
  std::vector<double> depths;
  for (const Return* echo : echoes)
    depths.push_back(echo->range - line.distance(echo->sonar));
  std::sort(depths.begin(), depths.end());
  opening.depth = depths[depths.size() / 2];
  const auto agree = std::count_if(depths.begin(), depths.end(), [&](double depth) {
    return std::abs(depth - opening.depth) < settings_.back_agree;
  });
  return 5 * static_cast<std::size_t>(agree) >= 4 * echoes.size() &&
         opening.depth >= settings_.min_back && opening.depth <= settings_.max_back;
}

/// True where the way through the gap is open, but narrower than the gap: a door stands open in its
/// frame or niche. Its ends are then where the echoes from behind the line, `back`, end.
bool SideView::find_way_in(const Line& line, const Stretch& before, const Stretch& after,
                           const std::vector<const Return*>& back, std::size_t other,
                           const std::deque<Return>& others, Opening& opening) const {
  const auto& through = opening.through;
  if (back.empty() || through.size() < static_cast<std::size_t>(settings_.min_through) ||
      4 * other > through.size())
    return false;
  const double first = line.u(through.front()->sonar);
  const double last = line.u(through.back()->sonar);
  std::vector<const Return*> sides[2];
  for (const Return* echo : back)
    if (const double u = line.u(echo->sonar); u < first || u > last)
      sides[u < first ? 0 : 1].push_back(echo);
  if (back.size() - sides[0].size() - sides[1].size() > through.size())
    return false;
  const std::vector<const Return*> backwards(through.rbegin(), through.rend());
  for (const bool upper : {true, false}) {
    const auto& side = sides[upper ? 0 : 1];
    End& end = upper ? opening.from : opening.to;
    end = {};
    if (side.empty()) {
      place_end(line, upper ? before : after, upper, upper ? through : backwards, others, end);
      continue;
    }
    // A corner is heard as farther back than the surface beside it.
    Line behind = line;
    double depth = settings_.through;
    for (const Return* echo : side)
      depth = std::min(depth, echo->range - line.distance(echo->sonar));
    behind.offset += depth;
    Stretch frame;
    frame.echoes = side;
    place_end(behind, frame, upper, upper ? through : backwards, others, end);
  }
  return opening.from.open && opening.to.open;
}

void SideView::place_end(const Line& line, const Stretch& stretch, bool upper,
                         const std::vector<const Return*>& beyond, const std::deque<Return>& others,
                         End& end) const {
  const Return& edge = *(upper ? stretch.echoes.back() : stretch.echoes.front());
  const double side = upper ? 1.0 : -1.0;
  const double u = line.u(edge.sonar);
  const double d = line.distance(edge.sonar);
  end.u = u;
  end.sigma = d * std::tan(settings_.corner_cone);
  if (beyond.empty())
    return;
  const double next = line.u(beyond.front()->sonar);
  if (std::abs(next - u) > kUnseen)
    return;
  end.open = beyond.size() >= 2;
  end.through = beyond;
  // The corner is heard while it is in the cone, which may look askew.
  const double tilt = side * std::atan2(edge.axis.dot(line.along()), edge.axis.dot(line.normal));
  const double past = d * std::tan(std::max(0.0, settings_.corner_cone - tilt));
  end.u = (u + next) / 2.0 - side * past;
  const double doubt = d * std::tan(settings_.corner_doubt);
  const double step = next - u;
  end.sigma = std::sqrt(step * step / 12.0 + doubt * doubt + 1e-4);

  // The same corner as heard from other places: on a circle and on the line.
  std::vector<std::pair<double, const Return*>> posts;
  const double cone = std::cos(settings_.post_cone);
  for (const Return& other : others) {
    const double h = line.distance(other.sonar);
    if (!other.steady || h < 0.15 || other.range < 1.05 * h ||
        std::abs(other.travelled - edge.travelled) > kPostWay ||
        std::abs(other.turned - edge.turned) > kPostTurn)
      continue;
    const double off = std::sqrt(other.range * other.range - h * h);
    for (const double sign : {-1.0, 1.0}) {
      const Vec2 way = (sign * off * line.along() + h * line.normal) / other.range;
      const double at = line.u(other.sonar) + sign * off;
      if (way.dot(other.axis) > cone && std::abs(at - end.u) < kPostNear)
        posts.emplace_back(at, &other);
    }
  }
  if (posts.size() < 2)
    return;
  std::stable_sort(posts.begin(), posts.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const double median = posts[posts.size() / 2].first;
  double sum = 0.0;
  for (const auto& [at, post] : posts)
    if (std::abs(at - median) < kPostAgree) {
      sum += at;
      end.posts.push_back(post);
    }
  if (end.posts.size() < 2) {
    end.posts.clear();
    return;
  }
  const double count = static_cast<double>(end.posts.size());
  const double at = sum / count;
  const double sigma = std::max(0.02, 0.04 / std::sqrt(count));
  const double weight = 1.0 / (sigma * sigma);
  const double before = 1.0 / (end.sigma * end.sigma);
  end.u = (weight * at + before * end.u) / (weight + before);
  end.sigma = 1.0 / std::sqrt(weight + before);
}

}  // namespace saphira::interpretation
