#include "saphira/console/board.hpp"

#include <algorithm>

#include "saphira/base/format.hpp"

namespace saphira::console {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += format("\\u%04x", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

int Board::topic(std::string name, std::size_t most) {
  topics_.push_back({std::move(name), most, 0});
  return static_cast<int>(topics_.size()) - 1;
}

void Board::put(int topic, const std::string& key, std::string json, double now,
                const std::string& owner) {
  auto [item, added] = items_.try_emplace({topic, key});
  item->second = {std::move(json), owner, ++version_, now};
  if (added && ++entry(topic).count > entry(topic).most)
    forget_oldest(topic);
}

void Board::withdraw(int topic, const std::string& key) {
  if (items_.erase({topic, key}) > 0)
    --entry(topic).count;
}

void Board::lose(int topic, const std::string& owner) {
  for (auto item = items_.lower_bound({topic, {}});
       item != items_.end() && item->first.first == topic;) {
    if (item->second.owner != owner) {
      ++item;
      continue;
    }
    item = items_.erase(item);
    --entry(topic).count;
  }
}

void Board::forget_oldest(int topic) {
  auto oldest = items_.end();
  for (auto item = items_.lower_bound({topic, {}});
       item != items_.end() && item->first.first == topic; ++item)
    if (oldest == items_.end() || item->second.version < oldest->second.version)
      oldest = item;
  items_.erase(oldest);
  --entry(topic).count;
}

void Board::append(std::string& items, const Place& place, double age,
                   const std::string& json) const {
  const std::string head = format(",\"a\":%.0f,\"d\":", 1000.0 * std::max(0.0, age));
  items += items.empty() ? "{\"t\":" : ",{\"t\":";
  items += quoted(topics_.at(static_cast<std::size_t>(place.first)).name);
  items += ",\"k\":" + quoted(place.second) + head + json + '}';
}

std::string Board::members(const std::vector<int>& topics, double now) const {
  std::string items;
  for (const int topic : topics)
    for (auto item = items_.lower_bound({topic, {}});
         item != items_.end() && item->first.first == topic; ++item)
      append(items, item->first, now - item->second.came, item->second.json);
  return format("\"now\":%.4f,\"items\":[", now) + items + ']';
}

std::optional<std::string> Board::frame(Viewer& viewer, double now) const {
  const std::deque<Viewer::UnderWay>& under_way = viewer.under_way;
  const bool whole = std::ranges::count_if(under_way, [](const auto& one) { return one.whole; }) <
                     settings_.unseen;
  const double delay =
      under_way.empty() ? viewer.delay : std::max(viewer.delay, now - under_way.front().sent);
  const bool full = delay > viewer.quickest + settings_.queue;
  if (!whole && (full || under_way.size() >= settings_.most_unseen))
    return std::nullopt;
  std::string items;
  for (auto had = viewer.has.begin(); had != viewer.has.end();) {
    if (items_.contains(had->first)) {
      ++had;
    } else {
      append(items, had->first, 0.0, "null");
      had = viewer.has.erase(had);
    }
  }
  for (const auto& [place, item] : items_) {
    if (!whole && place.first >= urgent_)
      break;
    std::uint64_t& has = viewer.has[place];
    if (has == item.version)
      continue;
    if (!items.empty() && items.size() + item.json.size() > settings_.frame_bytes) {
      if (has == 0)
        viewer.has.erase(place);
      break;
    }
    has = item.version;
    append(items, place, now - item.came, item.json);
  }
  if (items.empty() && (!whole || now - viewer.last < settings_.silence))
    return std::nullopt;
  viewer.last = now;
  viewer.under_way.push_back({++viewer.sent, now, whole});
  return format("{\"seq\":%llu,\"now\":%.4f,\"items\":[",
                static_cast<unsigned long long>(viewer.sent), now) +
         items + "]}";
}

void Board::seen(Viewer& viewer, std::uint64_t frame, double now) {
  std::deque<Viewer::UnderWay>& under_way = viewer.under_way;
  if (frame > viewer.sent)
    return;
  while (!under_way.empty() && under_way.front().frame <= frame) {
    viewer.delay = now - under_way.front().sent;
    viewer.quickest = std::min(viewer.quickest, viewer.delay);
    under_way.pop_front();
  }
}

}  // namespace saphira::console
