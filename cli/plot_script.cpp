#include "cli/plot_script.hpp"

#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace noether {

namespace {

/// Sizes in points; a PNG has two pixels per point.
constexpr double panel = 430, error_width = 470, title_height = 62, legend_row = 20;
constexpr double least_error_height = 176, between_errors = 78;
constexpr double left_margin = 74, right_margin = 20, bottom_margin = 58, gap = 74;

/// Colors that people with any color vision tell apart (P. Tol, "vibrant" and "bright").
constexpr std::array<const char*, 12> palette = {"#0077BB", "#EE7733", "#009988", "#CC3311", "#AA3377", "#33BBEE",
                                                 "#997700", "#228833", "#EE3377", "#4477AA", "#66443F", "#777777"};
constexpr const char* primary_color = "#E0A800";

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : plain_line(text)) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

const char* color_of(const PlotOrbit& orbit) {
  return orbit.primary ? primary_color : palette[orbit.color % palette.size()];
}

std::string block(const std::string& name, const std::vector<PlotPoint>& points) {
  std::string text = "$" + name + " << EOD\n";
  for (const PlotPoint& p : points) text += fmt::format("{:.9g} {:.9g}\n", p.x, p.y);
  return text + "EOD\n";
}

/// Where the panels stand: everything in points, origin at the lower left.
class Layout {
 public:
  explicit Layout(const PlotData& data) : orbit_panels_(data.orbits.size()), error_panels_(data.errors.size()) {
    if (data.orbits.empty()) return;
    double x = 0;
    for (const PlotOrbit& orbit : data.orbits[0].orbits) {
      if (legend_.size() == palette.size()) break;
      const double wide = 40 + 7.2 * static_cast<double>(orbit.name.size());
      if (x > 0 && x + wide > orbits_width()) x = 0, ++legend_rows_;
      legend_.push_back({x, static_cast<double>(legend_rows_)});
      x += wide;
    }
    ++legend_rows_;
  }
  double width() const {
    const double between = orbit_panels_ > 0 && error_panels_ > 0 ? gap + 12 : 0;
    return left_margin + orbits_width() + between + (error_panels_ > 0 ? error_width : 0) + right_margin;
  }
  double height() const { return bottom() + tall() + title_height; }

  std::string orbit_margins(std::size_t k) const {
    return margins(left_margin + static_cast<double>(k) * (panel + gap), bottom() + tall() - panel, panel, panel);
  }
  std::string error_margins(std::size_t k) const {
    const auto rows = static_cast<double>(error_panels_);
    const double high = (tall() - (rows - 1) * between_errors) / rows;
    const double low = bottom() + (rows - 1 - static_cast<double>(k)) * (high + between_errors);
    return margins(width() - right_margin - error_width, low, error_width, high);
  }
  /// The legend under the orbits, a dot and a name for each body.
  std::string legend(const PlotOrbits& picture) const {
    std::string text;
    for (std::size_t k = 0; k < legend_.size(); ++k) {
      const double x = left_margin + 6 + legend_[k].x;
      const double y = tall() - panel + legend_row * (static_cast<double>(legend_rows_) - 0.4 - legend_[k].y);
      text += fmt::format("set label {} {} at {} left noenhanced tc rgb '#202020'", 10 + k,
                          quoted(picture.orbits[k].name), at(x, y));
      text += fmt::format(" point pt 7 ps 0.9 lc rgb '{}' offset 0.9,-0.2\n", color_of(picture.orbits[k]));
    }
    return text;
  }
  std::string at(double x, double y) const {
    return fmt::format("screen {:.5f}, screen {:.5f}", x / width(), y / height());
  }

 private:
  double orbits_width() const {
    const auto panels = static_cast<double>(orbit_panels_);
    return panels * panel + std::max(0.0, panels - 1) * gap;
  }
  /// Height of all panels: that of the orbits, or more where more than two errors stand one above the other.
  double tall() const {
    const auto rows = static_cast<double>(error_panels_);
    return std::max(panel, rows * least_error_height + (rows - 1) * between_errors);
  }
  double bottom() const { return bottom_margin + static_cast<double>(legend_rows_) * legend_row; }
  std::string margins(double left, double low, double wide, double high) const {
    return fmt::format(
        "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n"
        "set tmargin at screen {:.5f}\n",
        left / width(), (left + wide) / width(), low / height(), (low + high) / height());
  }

  std::size_t orbit_panels_, error_panels_;
  std::vector<PlotPoint> legend_;  ///< x, and the number of the row
  int legend_rows_ = 0;
};

std::string opening(const PlotData& data, const Layout& layout, PictureFormat format, const std::string& picture) {
  const double scale = format == PictureFormat::png ? 2 : 1;
  std::string text = fmt::format(
      "set encoding utf8\nset terminal {} enhanced size {:.0f},{:.0f} font 'sans,{:.0f}' linewidth {} "
      "background 'white'",
      format == PictureFormat::png ? "pngcairo" : "svg", layout.width() * scale, layout.height() * scale, 11 * scale,
      scale);
  text += format == PictureFormat::png ? fmt::format(" pointscale {}\n", scale) : "\n";
  text += "set output " + quoted(picture) + "\nset multiplot\n";
  text += fmt::format("set label 1 {} at {} left noenhanced font ',{:.0f}' tc rgb '#202020'\n", quoted(data.title),
                      layout.at(24, layout.height() - 20), 15 * scale);
  text += fmt::format("set label 2 {} at {} right noenhanced font ',{:.0f}' tc rgb '#707070'\n", quoted(data.subtitle),
                      layout.at(layout.width() - right_margin, layout.height() - 20), 10 * scale);
  return text +
         "set border 3 lw 0.8 lc rgb '#505050'\nset tics out nomirror scale 0.6 tc rgb '#303030'\n"
         "set grid back lt 1 lw 0.5 lc rgb '#E4E4E4'\nunset key\n";
}

std::string orbit_panel(const PlotOrbits& picture, std::size_t index, const Layout& layout) {
  std::string data, curves;
  const auto curve = [&](const std::string& text) { curves += (curves.empty() ? "plot " : ", \\\n     ") + text; };
  for (std::size_t k = 0; k < picture.orbits.size(); ++k) {
    const PlotOrbit& orbit = picture.orbits[k];
    const std::string name = fmt::format("o{}_{}", index, k), rgb = fmt::format("rgb '{}'", color_of(orbit));
    if (!orbit.samples.empty()) {
      data += block(name + "s", orbit.samples);
      curve(fmt::format("${}s with points pt 7 ps 0.25 lc rgb '#90{}'", name, color_of(orbit) + 1));
    }
    if (!orbit.path.empty()) {
      data += block(name + "p", orbit.path);
      curve(fmt::format("${}p with lines lw 1.3 lc {}", name, rgb));
    }
  }
  for (std::size_t k = 0; k < picture.orbits.size(); ++k) {
    const PlotOrbit& orbit = picture.orbits[k];
    data += block(fmt::format("o{}_{}e", index, k), {orbit.end});
    const double dot = orbit.primary ? 1.1 : 0.9;
    curve(fmt::format("$o{}_{}e with points pt 7 ps {} lc rgb '{}'", index, k, dot, color_of(orbit)));
  }
  std::string text = data + layout.orbit_margins(index);
  text += fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n", picture.low.x, picture.high.x,
                      picture.low.y, picture.high.y);
  text += "unset logscale\nset format '%g'\nset xtics autofreq\nset ytics autofreq\n";
  text += fmt::format("set title {} offset 0,-0.6 noenhanced tc rgb '#303030'\n", quoted(picture.title));
  text += fmt::format("set xlabel {} offset 0,0.3 noenhanced\nset ylabel {} offset 0.8,0 noenhanced\n",
                      quoted(picture.x_label), quoted(picture.y_label));
  if (index == 0) text += layout.legend(picture);
  return text + curves + "\nunset label\n";
}

/// The curves of a panel, their names in a key where there are several.
std::string error_curves(const PlotError& error, std::size_t panel_number) {
  std::string data, plot;
  for (std::size_t c = 0; c < error.curves.size(); ++c) {
    const PlotCurve& curve = error.curves[c];
    if (curve.points.empty()) continue;
    const std::string name = fmt::format("e{}_{}", panel_number, c);
    data += block(name, curve.points);
    const std::string style =
        curve.points.size() > 400 ? "with points pt 7 ps 0.2" : "with linespoints lw 1 pt 7 ps 0.35";
    plot += fmt::format("{}${} {} lc rgb '{}'", plot.empty() ? "plot " : ", ", name, style,
                        palette[(panel_number + c) % palette.size()]);
    // In the key a dot that can be seen.
    plot += curve.name.empty() ? " notitle"
                               : fmt::format(" notitle, NaN with points pt 7 ps 0.8 lc rgb '{}' title {}",
                                             palette[(panel_number + c) % palette.size()], quoted(curve.name));
  }
  // gnuplot refuses to draw nothing: an empty panel draws a point outside of it.
  return data + (plot.empty() ? "plot NaN" : plot) + "\nunset label\n";
}

std::string error_panel(const PlotData& all, std::size_t k, const Layout& layout) {
  const PlotError& error = all.errors[k];
  double low = INFINITY, high = 0;
  for (const PlotCurve& curve : error.curves) {
    for (const PlotPoint& p : curve.points) low = std::min(low, p.y), high = std::max(high, p.y);
  }
  const bool empty = !(high > 0), several = error.curves.size() > 1;
  // Rare dips of an error that changes sign would stretch the axis: few decades below the worst are enough.
  const double most = empty ? -14 : std::ceil(std::log10(high) + 0.1);
  const double bottom = empty ? -17 : std::max(std::floor(std::log10(low)), several ? -17.0 : most - 5);
  const double top = several ? most + std::ceil((most - bottom) / 4) : most;  // room for the key
  std::string text = layout.error_margins(k);
  text += fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [1e{:.0f}:1e{:.0f}]\nset logscale y\n", all.begin,
                      all.end > all.begin ? all.end : all.begin + 1, std::min(bottom, top - 2), top);
  text +=
      fmt::format("set format x '%g'\nset format y '10^{{%T}}'\nset ytics {}\n", several ? "1e-18,1e3" : "autofreq");
  const std::string worst = empty ? "exactly zero" : fmt::format("worst {:.1e}", error.worst);
  const std::string whose = several ? " of " + error.curves.back().name : "";
  text += fmt::format("set title {} offset 0,-0.6 noenhanced tc rgb '#303030'\n",
                      quoted(error.title + ": " + error.label + ", " + worst + whose));
  text += fmt::format("set xlabel {} offset 0,0.3 noenhanced\nunset ylabel\n", quoted(all.time_label));
  text += several ? "set key inside top right horizontal samplen 0.3 width -1\n" : "unset key\n";
  return text + error_curves(error, k);
}

}  // namespace

std::string plot_script(const PlotData& data, PictureFormat format, const std::string& picture) {
  const Layout layout(data);
  std::string text = opening(data, layout, format, picture);
  for (std::size_t k = 0; k < data.orbits.size(); ++k) text += orbit_panel(data.orbits[k], k, layout);
  for (std::size_t k = 0; k < data.errors.size(); ++k) text += error_panel(data, k, layout);
  return text + "unset multiplot\nunset output\n";
}

}  // namespace noether
