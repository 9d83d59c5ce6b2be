#include "saphira/security/documents.hpp"

#include <string_view>

#include "saphira/base/format.hpp"

namespace saphira::security {
namespace {

constexpr const char* kHeader =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\"\n"
    " xsi:noNamespaceSchemaLocation=\"http://www.omg.org/spec/DDS-SECURITY/20170901/";
constexpr const char* kDomains =
    "<domains><id_range><min>0</min><max>232</max></id_range></domains>\n";

std::string element(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">\n";
}

/// The content of the first element that begins so; empty where there is none.
std::string first(const std::string& text, std::string_view begin) {
  const std::size_t at = text.find(begin);
  if (at == std::string::npos)
    return {};
  const std::size_t from = at + begin.size();
  return text.substr(from, text.find('<', from) - from);
}

/// One direction: its topics, of one robot or of all.
std::string criteria(const std::string& direction, const std::string& topics,
                     const std::string& robot) {
  if (topics.empty())
    return {};
  return element(direction,
                 element("topics", topics) +
                     element("partitions", element("partition", robot.empty() ? "*" : robot)));
}

}  // namespace

std::string day_text(std::int64_t seconds) {
  return utc_text(seconds, "%Y-%m-%d %H:%M UTC");
}

std::string governance() {
  const std::string rule =
      element("topic_expression", "*") + element("enable_discovery_protection", "true") +
      element("enable_liveliness_protection", "true") +
      element("enable_read_access_control", "true") +
      element("enable_write_access_control", "true") +
      // The submessages: the data and their headers. A second encryption of the data alone would
      // cost time and hide nothing.
      element("metadata_protection_kind", "ENCRYPT") + element("data_protection_kind", "NONE");
  return std::string(kHeader) + "omg_shared_ca_governance.xsd\">\n" +
         element("domain_access_rules",
                 element("domain_rule",
                         kDomains + element("allow_unauthenticated_participants", "false") +
                             element("enable_join_access_control", "true") +
                             element("discovery_protection_kind", "ENCRYPT") +
                             element("liveliness_protection_kind", "ENCRYPT") +
                             element("rtps_protection_kind", "NONE") +
                             element("topic_access_rules", element("topic_rule", rule)))) +
         "</dds>\n";
}

std::string permissions(const Grant& grant, const Roles& roles) {
  std::string writes;
  std::string reads;
  for (const TopicRule& rule : roles.topics) {
    if (rule.writers.contains(grant.subject.role))
      writes += element("topic", rule.topic);
    if (rule.readers.contains(grant.subject.role))
      reads += element("topic", rule.topic);
  }
  return std::string(kHeader) + "omg_shared_ca_permissions.xsd\">\n<permissions>\n<grant name=\"" +
         common_name(grant.subject) + "\">\n" + element("subject_name", to_text(grant.subject)) +
         element("validity", element("not_before", utc_text(grant.from, "%Y-%m-%dT%H:%M:%S")) +
                                 element("not_after", utc_text(grant.until, "%Y-%m-%dT%H:%M:%S"))) +
         element("allow_rule", kDomains + criteria("publish", writes, grant.robot) +
                                   criteria("subscribe", reads, grant.robot)) +
         element("default", "DENY") + "</grant>\n</permissions>\n</dds>\n";
}

std::string robot_of(const std::string& permissions) {
  const std::string robot = first(permissions, "<partition>");
  return robot == "*" ? "" : robot;
}

std::string subject_of(const std::string& permissions) {
  return first(permissions, "<subject_name>");
}

}  // namespace saphira::security
