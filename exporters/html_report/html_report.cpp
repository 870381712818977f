// Based on: the HTML standard, section 4.12.1 (data blocks).
// Differs: the same under both rules.
#include "html_report.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>

#include "shell.h"

namespace colod {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::string_view kMark = "<!--DATA-->";  ///< where the data go in the shell
constexpr std::size_t kMostWarnings = 20, kMostCharacters = 400;

/// Six digits are more than a page shows, and a third of the bytes.
void round_numbers(OrderedJson& json) {
  if (json.is_structured()) {
    for (OrderedJson& item : json) round_numbers(item);
  } else if (json.is_number_float()) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", json.get<double>());
    json = std::strtod(text, nullptr);
  }
}

/// At a character's border, so that UTF-8 stays whole.
std::string cut(std::string text) {
  if (text.size() <= kMostCharacters) return text;
  std::size_t end = kMostCharacters;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end) + " …";
}

void bound_texts(OrderedJson& building) {
  OrderedJson& warnings = building["warnings"];
  const std::size_t count = warnings.size();
  if (count > kMostWarnings) {
    warnings.erase(warnings.begin() + kMostWarnings, warnings.end());
    warnings.push_back("and " + std::to_string(count - kMostWarnings) + " more: see report.json");
  }
  for (OrderedJson& w : warnings) w = cut(w.get<std::string>());
  for (OrderedJson& layer : building["layers"]) {
    if (layer.contains("failure")) layer["failure"] = cut(layer["failure"].get<std::string>());
    if (layer.contains("looks")) layer["looks"].erase("worst");  // the pictures say where
  }
  if (building.contains("failure"))
    building["failure"] = cut(building["failure"].get<std::string>());
}

/// JSON in which no `<` can end the block or open a comment. Outside strings JSON has none.
std::string block(const char* id, const std::string& json) {
  std::string text = std::string("<script type=\"application/json\" id=\"") + id + "\">";
  for (const char c : json) c == '<' ? text += "\\u003c" : text += c;
  return text + "</script>\n";
}

std::string pictures_json(const std::vector<std::vector<std::string>>& pictures) {
  std::string text = "[";
  for (const std::vector<std::string>& building : pictures) {
    if (text.size() > 1) text += ",\n";
    text += "[";
    for (std::size_t i = 0; i < building.size(); ++i) {
      text += i > 0 ? ",\"" : "\"";
      const bool is_photo = building[i].starts_with("\xFF\xD8");
      if (!building[i].empty())
        text +=
            (is_photo ? "data:image/jpeg;base64," : "data:image/png;base64,") + base64(building[i]);
      text += "\"";
    }
    text += "]";
  }
  return text + "]";
}

/// The report as the page has it, building by building: each alone is parsed.
std::string report_text(OrderedJson report, const HtmlReport& r) {
  OrderedJson own = std::move(report["buildings"]);
  std::string rows;
  const auto add = [&](OrderedJson building) {
    bound_texts(building);
    round_numbers(building);
    rows += (rows.empty() ? "" : ",") + building.dump();
  };
  for (OrderedJson& building : own) add(std::move(building));
  for (std::size_t i = 0; i < r.buildings; ++i) add(OrderedJson::parse(r.building(i)));
  report["buildings"] = OrderedJson::array();
  round_numbers(report);
  std::string text = "{";
  for (const auto& [key, value] : report.items())
    text += (text.size() > 1 ? "," : "") + OrderedJson(key).dump() + ":" +
            (key == "buildings" ? "[" + rows + "]" : value.dump());
  return text + "}";
}

}  // namespace

Encoded encode_html_report(const HtmlReport& r) {
  OrderedJson report = OrderedJson::parse(r.report);
  OrderedJson parts = r.parts.empty() ? OrderedJson::object() : OrderedJson::parse(r.parts);
  parts["colors"] = r.layer_colors;
  round_numbers(parts);
  const std::string_view shell = kHtmlReportShell;
  const std::size_t mark = shell.find(kMark);
  std::string page(shell.substr(0, mark));
  page += block("report-data", report_text(std::move(report), r));
  page += block("parts-data", parts.dump());
  page += block("pictures-data", pictures_json(r.pictures));
  page += shell.substr(mark + kMark.size());
  return {"report.html", std::move(page)};
}

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace colod
