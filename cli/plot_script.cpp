#include "cli/plot_script.hpp"

#include "cli/plot_axes.hpp"
#include "cli/plot_layout.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace noether {

namespace {

/// Colors that people with any color vision tell apart (P. Tol, "vibrant" and "bright").
constexpr std::array<std::uint32_t, 12> palette = {0x0077BB, 0xEE7733, 0x009988, 0xCC3311, 0xAA3377, 0x33BBEE,
                                                   0x997700, 0x228833, 0xEE3377, 0x4477AA, 0x66443F, 0x777777};
constexpr std::uint32_t central = 0xE0A800;
/// From low to high, equal steps for the eye, and for those who see few colors (S. van der Walt and N. Smith,
/// "viridis").
constexpr std::array<std::uint32_t, 9> scale_of_colors = {0x440154, 0x472D7B, 0x3B528B, 0x2C728E, 0x21918C,
                                                          0x28AE80, 0x5EC962, 0xADDC30, 0xFDE725};
/// Bonds are drawn between particles of so many layers of depth.
constexpr int layers = 24;
/// More particles than this are plain dots: their edges and lights could not be seen.
constexpr std::size_t most_spheres = 8'000;

std::uint32_t rgb_of(std::size_t color) { return color == primary_color ? central : palette[color % palette.size()]; }

std::string color_of(std::size_t color) { return fmt::format("#{:06X}", rgb_of(color)); }

/// A color on its way to another one: 0 stays, 1 arrives.
std::uint32_t mixed(std::uint32_t from, std::uint32_t to, double part) {
  std::uint32_t result = 0;
  for (const int shift : {16, 8, 0}) {
    const double a = (from >> shift) & 0xFFU, b = (to >> shift) & 0xFFU;
    result |= static_cast<std::uint32_t>(std::lround(a + (b - a) * part)) << shift;
  }
  return result;
}

/// What is far away is paler, in a few shades.
std::uint32_t shaded(std::size_t color, double depth) {
  return mixed(rgb_of(color), 0xFFFFFF, 0.6 * std::round(depth * 12) / 12);
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : plain_line(text)) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

std::string block(const std::string& name, const std::vector<PlotPoint>& points) {
  std::string text = "$" + name + " << EOD\n";
  for (const PlotPoint& p : points) text += fmt::format("{:.15g} {:.15g}\n", p.x, p.y);
  return text + "EOD\n";
}

std::string block(const std::string& name, const std::vector<PlotPlace>& points) {
  std::string text = "$" + name + " << EOD\n";
  for (const PlotPlace& p : points) text += fmt::format("{:.15g} {:.15g} {:.15g}\n", p[0], p[1], p[2]);
  return text + "EOD\n";
}

class Script {
 public:
  Script(const PlotData& data, PictureFormat format) : data_(data), layout_(data), format_(format) {}

  std::string whole(const std::string& picture) {
    text_ = opening(picture);
    for (std::size_t k = 0; k < data_.orbits.size(); ++k) add_orbits(k);
    for (std::size_t k = 0; k < data_.boxes.size(); ++k) add_box(k);
    for (std::size_t k = 0; k < data_.panels.size(); ++k) add_panel(k);
    return text_ + "unset multiplot\nunset output\n";
  }

 private:
  std::string at(double x, double y) const {
    return fmt::format("screen {:.5f}, screen {:.5f}", x / layout_.width(), y / layout_.height());
  }
  std::string margins(const PlotArea& area) const {
    return fmt::format(
        "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n"
        "set tmargin at screen {:.5f}\n",
        area.left / layout_.width(), (area.left + area.wide) / layout_.width(), area.low / layout_.height(),
        (area.low + area.high) / layout_.height());
  }

  std::string terminal() const {
    const double wide = layout_.width(), high = layout_.height();
    if (format_ == PictureFormat::pdf) {
      return fmt::format("pdfcairo enhanced size {:.4f}in,{:.4f}in font 'sans,11' linewidth 1 background 'white'",
                         wide / 72, high / 72);
    }
    // A PNG has two pixels per point.
    if (format_ == PictureFormat::png) {
      return fmt::format(
          "pngcairo enhanced size {:.0f},{:.0f} font 'sans,22' linewidth 2 background 'white' pointscale 2", 2 * wide,
          2 * high);
    }
    return fmt::format("svg enhanced size {:.0f},{:.0f} font 'sans,11' linewidth 1 background 'white'", wide, high);
  }

  std::string opening(const std::string& picture) const {
    const double scale = format_ == PictureFormat::png ? 2 : 1;
    std::string text = "set encoding utf8\nset terminal " + terminal() + "\n";
    text += "set output " + quoted(picture) + "\nset multiplot\n";
    text += fmt::format("set label 1 {} at {} left noenhanced font ',{:.0f}' tc rgb '#202020'\n", quoted(data_.title),
                        at(24, layout_.height() - 20), 15 * scale);
    const std::string& method = data_.subtitle;
    const bool beside = layout_.method_beside_title();
    text += fmt::format("set label 2 {} at {} {} noenhanced font ',{:.0f}' tc rgb '#707070'\n", quoted(method),
                        beside ? at(layout_.width() - 30, layout_.height() - 20) : at(24, layout_.height() - 38),
                        beside ? "right" : "left", 10 * scale);
    for (std::size_t k = 0; k < data_.legend.size(); ++k) {
      text += fmt::format(
          "set label {} {} at {} left noenhanced tc rgb '#202020' point pt 7 ps 0.9 lc rgb '{}' "
          "offset 0.9,-0.2\n",
          10 + k, quoted(data_.legend[k].name), at(layout_.legend()[k].x, layout_.legend()[k].y),
          color_of(data_.legend[k].color));
    }
    return text + frame();
  }
  static std::string frame() {
    return "set border 3 lw 0.8 lc rgb '#505050'\nset tics out nomirror scale 0.6 tc rgb '#303030'\n"
           "set grid back lt 1 lw 0.5 lc rgb '#E4E4E4'\nunset key\n";
  }

  /// Ends a panel: gnuplot refuses to draw nothing, so an empty one draws a point outside of it.
  void plot(const std::vector<std::string>& curves) {
    std::string all;
    for (const std::string& curve : curves) all += (all.empty() ? "plot " : ", \\\n     ") + curve;
    text_ += (all.empty() ? "plot NaN notitle" : all) + "\nunset label\n";
  }

  /// Title and names of the axes; that of the values stands at a fixed distance, clear of the numbers.
  void add_titles(const PlotArea& area, const std::string& title, const std::string& x, const std::string& y) {
    const double scale = format_ == PictureFormat::png ? 2 : 1;
    const bool narrow = 7.8 * static_cast<double>(title.size()) > area.wide + 40;
    text_ += fmt::format("set title {} offset 0,-0.6 noenhanced font ',{:.1f}' tc rgb '#303030'\n", quoted(title),
                         (narrow ? 9 : 11) * scale);
    text_ += fmt::format("set xlabel {} offset 0,0.3 noenhanced\nunset ylabel\n", quoted(x));
    if (y.empty()) return;
    text_ += fmt::format("set label 3 {} at {} center rotate by 90 noenhanced\n", quoted(y),
                         at(area.left - 66, area.low + area.high / 2));
  }

  void add_orbits(std::size_t index) {
    const PlotOrbits& picture = data_.orbits[index];
    for (std::size_t k = 0; k < picture.orbits.size(); ++k) {
      const PlotOrbit& orbit = picture.orbits[k];
      const std::string name = fmt::format("o{}_{}", index, k);
      if (!orbit.samples.empty()) text_ += block(name + "s", orbit.samples);
      if (!orbit.path.empty()) text_ += block(name + "p", orbit.path);
      text_ += block(name + "e", std::vector<PlotPlace>{orbit.end});
    }
    for (std::size_t k = 0; k < picture.links.size(); ++k) {
      text_ += lines_block(fmt::format("l{}_{}", index, k), picture.links[k].lines);
    }
    for (std::size_t v = 0; v < picture.views.size(); ++v) add_view(index, v);
  }

  void add_view(std::size_t index, std::size_t v) {
    const PlotOrbits& picture = data_.orbits[index];
    const PlotView& view = picture.views[v];
    const PlotArea& area = layout_.orbits(index, v);
    text_ += margins(area);
    text_ += fmt::format("set xrange [{:.15g}:{:.15g}]\nset yrange [{:.15g}:{:.15g}]\n", view.low.x, view.high.x,
                         view.low.y, view.high.y);
    // All views have one scale, and so one power of ten.
    const PlotView& first = picture.views[0];
    const int power = marks_of(first.low.x, first.high.x, 7).power;
    text_ += "unset logscale\n";
    const PlotMarks across = marks_of(view.low.x, view.high.x, most_marks('x', area.wide), power);
    const PlotMarks up = marks_of(view.low.y, view.high.y, most_marks('y', area.high), power);
    set_tics('x', across);
    set_tics('y', up);
    add_titles(area, v == 0 ? picture.title : "", axis_name(view.across_label, across), axis_name(view.up_label, up));
    std::vector<std::string> curves;
    const std::string columns = fmt::format("using {}:{}", view.across + 1, view.up + 1);
    for (std::size_t k = 0; k < picture.orbits.size(); ++k) {
      const PlotOrbit& orbit = picture.orbits[k];
      const std::string name = fmt::format("$o{}_{}", index, k), color = color_of(orbit.color);
      if (!orbit.samples.empty()) {
        curves.push_back(fmt::format("{}s {} with points pt 7 ps 0.25 lc rgb '#90{}'", name, columns, color.substr(1)));
      }
      if (!orbit.path.empty())
        curves.push_back(fmt::format("{}p {} with lines lw 1.3 lc rgb '{}'", name, columns, color));
    }
    for (std::size_t k = 0; k < picture.links.size(); ++k) {
      const double age = picture.links[k].age;
      const std::uint32_t rgb = age > 0 ? mixed(rgb_of(0), 0xFFFFFF, 0.35 + 0.5 * age) : 0x404040;
      curves.push_back(
          fmt::format("$l{}_{} {} with lines lw {} lc rgb '#{:06X}'", index, k, columns, age > 0 ? 1.0 : 1.8, rgb));
    }
    for (std::size_t k = 0; k < picture.orbits.size(); ++k) {
      const PlotOrbit& orbit = picture.orbits[k];
      curves.push_back(fmt::format("$o{}_{}e {} with points pt 7 ps {:.2g} lc rgb '{}'", index, k, columns,
                                   (orbit.primary ? 1.1 : 0.9) * picture.size_of_bodies, color_of(orbit.color)));
    }
    plot(curves);
  }

  /// Sets the marks of an axis, with room for their numbers.
  void set_tics(char name, const PlotMarks& marks) {
    std::string list;
    std::size_t longest = 0;
    for (const auto& [at, text] : marks.marks) {
      list += fmt::format("{}'{}' {:.15g}", list.empty() ? "" : ", ", text, at);
      longest = std::max(longest, text.size());
    }
    // Long numbers are small, so that they do not touch the name of the axis.
    const double scale = format_ == PictureFormat::png ? 2 : 1;
    text_ += fmt::format("set format {0} '%g'\nset {0}tics nomirror {1} font ',{2:.0f}'\n", name,
                         list.empty() ? "autofreq" : "(" + list + ")", (longest > 6 ? 9 : 11) * scale);
  }

  /// So many marks have room on an axis.
  static double most_marks(char name, double points) { return std::clamp(points / (name == 'x' ? 58 : 30), 2.0, 7.0); }

  static std::string lines_block(const std::string& name, const std::vector<std::pair<PlotPlace, PlotPlace>>& lines) {
    std::string text = "$" + name + " << EOD\n";
    for (const auto& [a, b] : lines) {
      text += fmt::format("{:.15g} {:.15g} {:.15g}\n{:.15g} {:.15g} {:.15g}\n\n", a[0], a[1], a[2], b[0], b[1], b[2]);
    }
    return text + "EOD\n";
  }

  static std::string edges_block(const std::string& name, const std::vector<std::pair<PlotPoint, PlotPoint>>& edges) {
    std::string text = "$" + name + " << EOD\n";
    for (const auto& [a, b] : edges) text += fmt::format("{:.5g} {:.5g}\n{:.5g} {:.5g}\n\n", a.x, a.y, b.x, b.y);
    return text + "EOD\n";
  }

  /// A disc as rows of a block: a dark edge, its color, and a light where it is lit.
  std::string rows_of(const PlotDisc& disc, bool sphere, double unit) const {
    const std::uint32_t color = shaded(disc.color, disc.depth);
    std::string rows;
    const auto row = [&](double dx, double dy, double part, std::uint32_t rgb) {
      rows += fmt::format("{:.5g} {:.5g} {:.4g} {}\n", disc.x + dx * disc.radius, disc.y + dy * disc.radius,
                          part * disc.radius * unit, rgb);
    };
    if (!sphere) {
      row(0, 0, 1, color);
      return rows;
    }
    row(0, 0, 1, mixed(color, 0x101820, 0.45));
    row(-0.04, 0.04, 0.88, color);
    row(-0.3, 0.32, 0.3, mixed(color, 0xFFFFFF, 0.5));
    return rows;
  }

  void add_box(std::size_t index) {
    const PlotBox& picture = data_.boxes[index];
    const PlotArea& area = layout_.box(index);
    const double points = area.wide / (picture.high.x - picture.low.x);
    // SVG has circles as marks of a size in points; elsewhere they are drawn in units of the axis.
    const bool marks = format_ == PictureFormat::svg;
    const double unit = marks ? points / 4.125 : 1;
    const bool spheres = picture.discs.size() <= most_spheres;
    text_ += margins(area);
    text_ += fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\nunset logscale\n", picture.low.x,
                         picture.high.x, picture.low.y, picture.high.y);
    text_ += "unset border\nunset tics\nunset grid\n";
    add_titles(area, picture.title, "", "");
    text_ += edges_block(fmt::format("b{}f", index), picture.far_edges);
    text_ += edges_block(fmt::format("b{}n", index), picture.near_edges);
    std::vector<std::string> curves;
    if (!picture.far_edges.empty()) curves.push_back(fmt::format("$b{}f with lines lw 0.8 lc rgb '#A0A0A0'", index));
    const std::string style =
        marks ? "with points pt 7 ps variable lc rgb variable" : "with circles fill solid noborder lc rgb variable";
    const int count = picture.sticks.empty() ? 1 : layers;
    for (int layer = count - 1; layer >= 0; --layer) {
      const auto inside = [&](double depth) {
        return std::clamp(static_cast<int>(depth * count), 0, count - 1) == layer;
      };
      std::string sticks, discs;
      for (const PlotStick& stick : picture.sticks) {
        if (!inside(stick.depth)) continue;
        sticks += fmt::format("{:.5g} {:.5g} {:.5g} {:.5g} {}\n", stick.from.x, stick.from.y, stick.to.x - stick.from.x,
                              stick.to.y - stick.from.y, mixed(shaded(stick.color, stick.depth), 0x101820, 0.15));
      }
      for (const PlotDisc& disc : picture.discs) {
        if (inside(disc.depth)) discs += rows_of(disc, spheres, unit);
      }
      if (!sticks.empty()) {
        const double wide = std::clamp(0.7 * picture.discs.back().radius * points, 0.6, 6.0);
        text_ += fmt::format("$b{}s{} << EOD\n{}EOD\n", index, layer, sticks);
        curves.push_back(
            fmt::format("$b{}s{} using 1:2:3:4:5 with vectors nohead lw {:.2f} lc rgb variable", index, layer, wide));
      }
      if (!discs.empty()) {
        text_ += fmt::format("$b{}d{} << EOD\n{}EOD\n", index, layer, discs);
        curves.push_back(fmt::format("$b{}d{} using 1:2:3:4 {}", index, layer, style));
      }
    }
    if (!picture.near_edges.empty()) curves.push_back(fmt::format("$b{}n with lines lw 0.8 lc rgb '#606060'", index));
    plot(curves);
    text_ += frame();
  }

  /// @return what the axis is called
  std::string add_axis(const PlotAxis& axis, char name, double points) {
    text_ += fmt::format("set {}range [{:.15g}:{:.15g}]\n", name, axis.low, axis.high);
    if (!axis.logarithmic) {
      const PlotMarks marks = marks_of(axis.low, axis.high, most_marks(name, points));
      text_ += fmt::format("unset logscale {}\n", name);
      set_tics(name, marks);
      return axis_name(axis.label, marks);
    }
    const double decades = std::log10(axis.high / axis.low);
    // Every second decade, or third, where labels would meet.
    const double most = std::max(2.0, points / (name == 'x' ? 44 : 26));
    const double step = std::max(1.0, std::ceil(decades / most));
    text_ += fmt::format("set logscale {0}\nset {0}tics font ',{1}'\n", name, format_ == PictureFormat::png ? 22 : 11);
    if (decades < 2) {
      const PlotMarks marks = decade_marks_of(axis.low, axis.high);
      set_tics(name, marks);
      return axis_name(axis.label, marks);
    }
    text_ += fmt::format("set format {0} '10^{{%T}}'\nset {0}tics nomirror 1e-30,{1:g}\n", name, std::pow(10.0, step));
    return axis.label;
  }

  /// The bar of colors beside a panel.
  void add_scale(const PlotAxis& scale, const PlotArea& area) {
    std::string colors;
    for (std::size_t k = 0; k < scale_of_colors.size(); ++k)
      colors += fmt::format("{}{} '#{:06X}'", k == 0 ? "" : ", ", k, scale_of_colors[k]);
    text_ += fmt::format("set palette defined ({})\nset cbrange [{:.15g}:{:.15g}]\n", colors, scale.low, scale.high);
    const PlotMarks marks =
        scale.logarithmic ? PlotMarks{} : marks_of(scale.low, scale.high, most_marks('y', area.high));
    std::string list;
    for (const auto& [at, text] : marks.marks)
      list += fmt::format("{}'{}' {:.15g}", list.empty() ? "" : ", ", text, at);
    text_ += fmt::format("{}set logscale cb\nset format cb '%g'\nset cbtics {}\n", scale.logarithmic ? "" : "un",
                         list.empty() ? "autofreq" : "(" + list + ")");
    const std::string label = axis_name(scale.label, marks);
    text_ += fmt::format(
        "set cblabel {} noenhanced\nset colorbox vertical user origin screen {:.5f},{:.5f} size screen "
        "{:.5f},{:.5f} noborder\n",
        quoted(label), (area.left + area.wide + 14) / layout_.width(), area.low / layout_.height(),
        14 / layout_.width(), area.high / layout_.height());
  }

  /// Cells or points whose colors tell a number.
  void add_colored(const PlotPanel& panel, const PlotArea& area, std::size_t k) {
    add_scale(panel.colors->scale, area);
    const std::vector<PlotPoint>& points = panel.curves.front().points;
    text_ += fmt::format("$c{} << EOD\n", k);
    for (std::size_t p = 0; p < points.size(); ++p)
      text_ += fmt::format("{:.15g} {:.15g} {:.9g}\n", points[p].x, points[p].y, panel.colors->values[p]);
    text_ += "EOD\nunset key\nunset grid\n";
    const double size = std::clamp(9 / std::sqrt(static_cast<double>(points.size())), 0.25, 0.9);
    plot({panel.colors->cells ? fmt::format("$c{} using 1:2:3 with image", k)
                              : fmt::format("$c{} using 1:2:3 with points pt 7 ps {:.2f} lc palette", k, size)});
    text_ += frame() + "unset colorbox\n";
  }

  void add_panel(std::size_t k) {
    const PlotPanel& panel = data_.panels[k];
    const PlotArea& area = layout_.panel(k);
    text_ += margins(area);
    const std::string across = add_axis(panel.x, 'x', area.wide), up = add_axis(panel.y, 'y', area.high);
    add_titles(area, panel.title, across, up);
    if (panel.colors) return add_colored(panel, area, k);
    const bool key =
        std::any_of(panel.curves.begin(), panel.curves.end(), [](const auto& c) { return !c.name.empty(); });
    text_ += key ? "set key inside top right horizontal samplen 0.3 width 1 Left reverse noenhanced\n" : "unset key\n";
    std::vector<std::string> curves;
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      const PlotCurve& curve = panel.curves[c];
      if (curve.points.empty()) continue;
      const std::string name = fmt::format("p{}_{}", k, c);
      const std::string color = color_of(curve.color == automatic_color ? k + c : curve.color);
      text_ += block(name, curve.points);
      const std::string style = style_of(curve, panel);
      curves.push_back(fmt::format("${} {} lc rgb '{}' notitle", name, style, color));
      if (panel.large && !panel.points_alone) {
        text_ += block(name + "e", std::vector<PlotPoint>{curve.points.back()});
        curves.push_back(fmt::format("${}e with points pt 7 ps 0.9 lc rgb '{}' notitle", name, color));
      }
      // In the key a dot that can be seen.
      if (!curve.name.empty()) {
        curves.push_back(fmt::format("NaN with points pt 7 ps 0.8 lc rgb '{}' title {}", color, quoted(curve.name)));
      }
    }
    plot(curves);
  }

  static std::string style_of(const PlotCurve& curve, const PlotPanel& panel) {
    if (panel.points_alone) return "with points pt 7 ps 0.5";
    if (panel.large) return curve.dotted ? "with linespoints lw 1.3 pt 7 ps 0.35" : "with lines lw 1.3";
    const std::size_t count = curve.points.size();
    if (curve.separate && count > 400) return "with points pt 7 ps 0.2";
    return count > 120 ? "with lines lw 1" : "with linespoints lw 1 pt 7 ps 0.35";
  }

  const PlotData& data_;
  PlotLayout layout_;
  PictureFormat format_;
  std::string text_;
};

}  // namespace

std::string plot_script(const PlotData& data, PictureFormat format, const std::string& picture) {
  return Script(data, format).whole(picture);
}

}  // namespace noether
