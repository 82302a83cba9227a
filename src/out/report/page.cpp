// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/page.hpp"

#include <fmt/format.h>

#include <iterator>

#include "dermis/out/report/canvas.hpp"

namespace dermis::out::report {
namespace {

constexpr std::string_view kPageCss =
    ":root{color-scheme:light dark}\n"
    "*{box-sizing:border-box}\n"
    "body{margin:0;background:#fff;color:#1c2128;font:16px/1.5 system-ui,\"Segoe UI\",Helvetica,Arial,"
    "\"Liberation Sans\",sans-serif}\n"
    "main{max-width:1180px;margin:0 auto;padding:32px 20px 48px}\n"
    "h1{font-size:1.7rem;line-height:1.2;margin:0 0 4px;font-weight:650;overflow-wrap:anywhere}\n"
    "h2{font-size:1.15rem;margin:44px 0 10px;padding-top:12px;border-top:1px solid #d5dae0;font-weight:650}\n"
    "p{margin:8px 0;max-width:78ch}\n"
    ".muted,figcaption,.note{color:#59636e}\n"
    ".tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(150px,1fr));margin:24px 1px 8px 0}\n"
    ".tile{border:1px solid #d5dae0;margin:0 -1px -1px 0;padding:12px 14px}\n"
    ".tile b{display:block;font-size:1.75rem;line-height:1.25;font-weight:600;font-variant-numeric:tabular-nums;"
    "white-space:nowrap}\n"
    ".tile .long{font-size:1.2rem;line-height:2.1875rem}\n"
    ".tile span{display:block;font-size:.82rem;color:#59636e;overflow-wrap:anywhere}\n"
    // A shadow at each edge beyond which the table goes on; what covers it there moves with the table.
    ".scroll{overflow-x:auto;scrollbar-width:thin;scrollbar-color:#8b949e #0000;"
    "background:linear-gradient(90deg,#fff 30%,#fff0) 0 0/40px 100% no-repeat local,"
    "linear-gradient(270deg,#fff 30%,#fff0) 100% 0/40px 100% no-repeat local,"
    "linear-gradient(90deg,#59636e88,#59636e00) 0 0/14px 100% no-repeat,"
    "linear-gradient(270deg,#59636e88,#59636e00) 100% 0/14px 100% no-repeat}\n"
    "table{border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}\n"
    "th,td{padding:6px 12px 6px 0;text-align:left;vertical-align:top;border-bottom:1px solid #e3e7ec}\n"
    "thead th{vertical-align:bottom;border-bottom:1px solid #59636e;font-weight:600}\n"
    "tbody th{font-weight:500}\n"
    ".numbers{width:100%}\n"
    ".numbers th+th,.numbers td{text-align:right;white-space:nowrap;padding:6px 0 6px 14px}\n"
    ".numbers tbody th{white-space:nowrap}\n"
    ".numbers svg{width:12px;height:12px;margin-right:6px;vertical-align:-1px;display:inline}\n"
    ".numbers .group{text-align:center;border-bottom:1px solid #e3e7ec;font-weight:400;color:#59636e}.numbers thead "
    "td{border:0}\n"
    ".best,.beyond{font-weight:700}\n"
    ".compact{max-width:760px}.dense td,.dense tbody th{padding-top:2px;padding-bottom:2px}\n"
    "figure+.scroll,.panels+.scroll{margin-top:30px}sub{font-size:.72em;line-height:0}\n"
    ".numbers .beyond{text-decoration:underline;text-decoration-thickness:1px;text-underline-offset:3px}\n"
    ".claims{width:100%}.claims th,.claims td{padding-right:22px}.claims .verdict{font-weight:650;padding-right:0;"
    "min-width:8.5rem}\n"
    ".claims tbody th{width:9.5rem;color:#59636e;font-weight:400}.claims td{width:36%}.claims td.verdict{width:auto}\n"
    ".facts th{width:16rem;padding-right:20px;overflow-wrap:anywhere}\n"
    ".facts td{overflow-wrap:anywhere}\n"
    ".note{font-size:.86rem}\n"
    "figure{margin:28px 0 0;break-inside:avoid}\n"
    "figcaption{font-size:.9rem;max-width:84ch;margin-top:6px;overflow-wrap:anywhere}\n"
    "figcaption b{color:#1c2128}\n"
    ".panels{display:grid;gap:12px 20px}\n"
    ".panels .fig{display:block;width:100%;height:auto}\n"
    ".across1{max-width:560px}\n"
    ".across2{grid-template-columns:repeat(2,minmax(0,1fr))}\n"
    ".across3{grid-template-columns:repeat(3,minmax(0,1fr))}\n"
    ".across4{grid-template-columns:repeat(4,minmax(0,1fr))}\n"
    "@media screen and (max-width:820px){.across2,.across3{grid-template-columns:minmax(0,1fr)}"
    ".across4{grid-template-columns:repeat(2,minmax(0,1fr))}}\n"
    "@media screen and (max-width:640px){.claims thead{display:none}.claims tr{display:block;padding:8px 0;"
    "border-bottom:1px solid #d5dae0}.claims tbody th,.claims td,.claims td.verdict{display:block;width:auto;border:0;"
    "padding:2px 0}}\n"
    "@media screen and (max-width:480px){main{padding:20px 14px 36px}.facts "
    "th{width:11rem}.tiles{grid-template-columns:1fr "
    "1fr}}\n"
    "@media screen and (prefers-color-scheme:dark){\n"
    "body{background:#14181d;color:#e6eaf0}\n"
    ".scroll{background-image:linear-gradient(90deg,#14181d 30%,#14181d00),"
    "linear-gradient(270deg,#14181d 30%,#14181d00),linear-gradient(90deg,#9aa5b188,#9aa5b100),"
    "linear-gradient(270deg,#9aa5b188,#9aa5b100)}\n"
    "h2,.tile,.claims tr{border-color:#39424d}\n"
    "th,td{border-color:#2b323b}thead th{border-color:#8b96a3}.numbers .group{border-color:#2b323b}\n"
    ".muted,figcaption,.note,.tile span,.numbers .group,.claims tbody th{color:#9aa5b1}figcaption b{color:#e6eaf0}\n"
    "}\n"
    "@media print{main{max-width:none;padding:0}html,body{font-size:10pt}h2{break-after:avoid;margin-top:28px}"
    "tr{break-inside:avoid}.scroll{overflow:visible;background:none}.numbers th+th,.numbers td{padding-left:8px}}\n";

std::string series_key(std::size_t style) {
  return fmt::format(
      "<svg class=\"fig\" viewBox=\"0 0 12 12\" width=\"12\" height=\"12\" aria-hidden=\"true\"><g "
      "class=\"{}\"><path class=\"mark\" d=\"{}\"/></g></svg>",
      series_class(style), mark(style, {6.0, 6.0}));
}

/// Longer values are set smaller, so that a tile of the narrowest width holds them.
constexpr std::size_t kLongTile = 8;

/// Escaped words for an element.
std::string words_of(std::string_view words) {
  constexpr std::string_view kOmega = "\u03c9";
  std::string escaped = escape_xml(words);
  const std::string indexed = std::string(kOmega) + "_";
  for (std::size_t at = escaped.find(indexed); at != std::string::npos; at = escaped.find(indexed, at + 1)) {
    const std::size_t letter = at + indexed.size();
    if (letter == escaped.size()) break;
    escaped.replace(letter - 1, 2, fmt::format("<sub>{}</sub>", escaped[letter]));
  }
  return escaped;
}

std::string group_heads(const std::vector<Table::Group>& groups) {
  std::string heads = "<tr><td></td>";
  for (const Table::Group& group : groups) {
    heads += fmt::format("<th class=\"group\" colspan=\"{}\">{}</th>", group.columns, escape_xml(group.name));
  }
  return heads + "</tr>\n";
}

}  // namespace

Page::Page(std::string_view window, std::string_view title) {
  html_ = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n"
      "<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>{}</title>\n<style>\n{}{}</style>\n</head>\n<body>\n<main>\n<h1>{}</h1>\n",
      escape_xml(window), figure_css(), kPageCss, escape_xml(title));
}

void Page::heading(std::string_view words) {
  element("h2", "", words);
}

void Page::paragraph(std::string_view words, std::string_view style) {
  element("p", style, words);
}

void Page::tiles(const std::vector<Tile>& tiles) {
  html_ += "<div class=\"tiles\">\n";
  for (const Tile& tile : tiles) {
    html_ += "<div class=\"tile\">";
    element("span", "", tile.name);
    element("b", tile.value.size() > kLongTile ? "long" : "", tile.value);
    element("span", "", tile.note);
    if (!tile.explanation.empty()) element("span", "", tile.explanation);
    html_ += "</div>\n";
  }
  html_ += "</div>\n";
}

void Page::table(const Table& table) {
  html_ += fmt::format("<div class=\"scroll\"><table class=\"{}\">\n<thead>\n", table.style);
  if (!table.groups.empty()) html_ += group_heads(table.groups);
  html_ += "<tr>";
  for (const std::string& head : table.heads) element("th", "", head);
  html_ += "</tr>\n</thead>\n<tbody>\n";
  for (const Row& row : table.rows) {
    html_ += "<tr><th>" + (row.series ? series_key(*row.series) : "") + escape_xml(row.name) + "</th>";
    for (const Cell& cell : row.cells) element("td", cell.style, cell.words);
    html_ += "</tr>\n";
  }
  html_ += "</tbody></table></div>\n";
}

void Page::facts(const std::vector<Fact>& facts, std::string_view style) {
  html_ += fmt::format("<table class=\"{}\"><tbody>\n", style);
  for (const auto& [name, value] : facts) {
    html_ += "<tr>";
    element("th", "", name);
    element("td", "", value);
    html_ += "</tr>\n";
  }
  html_ += "</tbody></table>\n";
}

void Page::figure(const Figure& figure) {
  html_ += "<figure>\n";
  if (!figure.panels.empty()) {
    html_ += fmt::format("<div class=\"panels across{}\">\n", figure.columns);
    for (const Drawing& panel : figure.panels) html_ += svg_element(panel);
    html_ += "</div>\n";
  }
  html_ += fmt::format("<figcaption><b>Fig. {}. {}.</b> {}</figcaption>\n</figure>\n", ++figures_,
                       words_of(figure.title), words_of(figure.caption));
}

void Page::figures(const std::vector<Figure>& figures) {
  html_ += "<div class=\"panels across2\">\n";
  for (const Figure& figure : figures) this->figure(figure);
  html_ += "</div>\n";
}

void Page::element(std::string_view tag, std::string_view style, std::string_view words) {
  const std::string attribute = style.empty() ? "" : fmt::format(" class=\"{}\"", style);
  fmt::format_to(std::back_inserter(html_), "<{0}{1}>{2}</{0}>", tag, attribute, words_of(words));
}

std::string Page::html() && {
  html_ += "</main>\n</body>\n</html>\n";
  return std::move(html_);
}

}  // namespace dermis::out::report
