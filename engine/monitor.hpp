#pragma once
/// Monitors and writers: what watches a run. They see settled copies and cannot change the trajectory.

#include "engine/seam.hpp"
#include "engine/snapshot.hpp"
#include "numbers/members.hpp"

#include <concepts>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// One quantity of a monitor at one moment, as files store it.
struct Series {
  std::string name;          ///< "relative_error"
  std::string dimension;     ///< in words, "1" for none; where columns differ, one for each: "length, 1, angle"
  std::vector<Index> shape;  ///< of one sample; empty for a number
  std::vector<double> values;
  std::vector<std::string> columns = {};  ///< names along the last axis of the shape, where it has any
  std::vector<std::int64_t> orders = {};  ///< or orders along it, of one quantity to several orders
};

/// All quantities of one monitor at one moment.
struct Sample {
  std::string_view monitor;
  std::int64_t step = 0;
  double time = 0;
  std::span<const Series> series;
  std::optional<double> scale;  ///< what relative errors are relative to
};

/// What a monitor has to say at the end. A number that makes no sense for it stays empty.
struct MonitorReport {
  std::optional<double> first, last, worst, rms, slope, slope_error, scale;
  std::string slope_unit;
  std::optional<double> drift, drift_error;  ///< of molecules: the slope by atom, in the field's own unit
  std::string drift_unit;
  std::string reason;  ///< why figures are empty that this monitor would have in another run
  std::string note;    ///< what else there is to say
  std::int64_t samples = 0;
  std::vector<std::int64_t> orders;        ///< of a monitor that watches one quantity to several orders
  std::vector<double> fluctuation;         ///< of each order: rms about the mean, relative to the scale
  std::optional<std::int64_t> best_order;  ///< the one that fluctuates least
  std::string verdict;                     ///< what the figures say about the run, in words
};

/// Watches settled states. Optional members: `wanted()` (energy?), `series()` and `scale()` (what files store),
/// `report()`, `record(Sample)` (receives every monitor's samples: writers, who look where a run stops or fails too),
/// `flush()`, `finish(Outcome)`,
/// `at_start(snapshot)` (the state that a run goes on from, where a list of times tells when to look: writers make
/// their files, errors of what is conserved are measured from there), `at_end(snapshot)` (the end of a run that is no
/// look of its own, to be forgotten at the next one), `steps_in_a_row()` (looks at so many steps from each multiple of
/// its cadence on), `forget()` (somebody has edited the run), `check(state)` (throws for a state that it cannot watch),
/// a static `looks_last` for what must see a moment after all others (checkpoints), a static `needs_equal_intervals`
/// for what counts lags in looks, and a static `needs_particles` for what makes no sense of a system that has variables
/// instead.
template <class M, class Real>
concept Monitor = requires(M& m, const Snapshot<Real>& snapshot) {
  m.observe(snapshot);
};

namespace detail {

NOETHER_FINDS_MEMBER(wanted, wnated, watned, wantde, wated, wantd, watend)
NOETHER_FINDS_MEMBER(series, seires, sereis, serise, sreies, seriess, serie)
NOETHER_FINDS_MEMBER(scale, sclae, sacle, scael, csale, scal, scalee)
NOETHER_FINDS_MEMBER(report, reprot, repotr, rpeort, reoprt, repport, reportt)
NOETHER_FINDS_MEMBER(record, recrod, recodr, rceord, reocrd, reccord, recordd)
NOETHER_FINDS_MEMBER(flush, fluhs, flsuh, fulsh, lfush, flusch, flushh)
NOETHER_FINDS_MEMBER(finish, finsih, fnish, finihs, fiinsh, finnish, finishh)
NOETHER_FINDS_MEMBER(at_start, at_strat, at_satrt, at_statr, at_the_start, at_begin, atstart)
NOETHER_FINDS_MEMBER(at_end, at_edn, at_ned, at_the_end, at_ends, at_finish, atend)
NOETHER_FINDS_MEMBER(forget, froget, foregt, forgte, fogret, forgett, forgret)

template <class M>
concept SaysWhatItWants = requires(const M& monitor) {
  { monitor.wanted() } -> std::convertible_to<Request>;
};
template <class M>
concept GivesSeries = requires(const M& monitor) {
  { monitor.series() } -> std::convertible_to<std::vector<Series>>;
};
template <class M>
concept GivesScale = requires(const M& monitor) {
  { monitor.scale() } -> std::convertible_to<std::optional<double>>;
};
template <class M>
concept Reports = requires(const M& monitor) {
  { monitor.report() } -> std::convertible_to<std::optional<MonitorReport>>;
};
template <class M>
concept Records = requires(M& monitor, const Sample& sample) {
  monitor.record(sample);
};
template <class M>
concept Flushes = requires(M& monitor) {
  monitor.flush();
};
template <class M>
concept Finishes = requires(M& monitor, const Outcome& outcome) {
  monitor.finish(outcome);
};
template <class M>
concept Forgets = requires(M& monitor) {
  monitor.forget();
};

template <class M, class Real>
concept LooksAtTheStart = requires(M& monitor, const Snapshot<Real>& start) {
  monitor.at_start(start);
};
template <class M, class Real>
concept LooksAtTheEnd = requires(M& monitor, const Snapshot<Real>& end) {
  monitor.at_end(end);
};

/// Whether each optional member of a monitor, where there is one of its name, is what it has to be.
template <class M> struct MonitorMembers {
  static constexpr bool wanted = !misspells_wanted<M>() && (!finds_wanted<M>() || SaysWhatItWants<M>);
  static constexpr bool series = !misspells_series<M>() && (!finds_series<M>() || GivesSeries<M>);
  static constexpr bool scale = !misspells_scale<M>() && (!finds_scale<M>() || GivesScale<M>);
  static constexpr bool report = !misspells_report<M>() && (!finds_report<M>() || Reports<M>);
  static constexpr bool record = !misspells_record<M>() && (!finds_record<M>() || Records<M>);
  static constexpr bool flush = !misspells_flush<M>() && (!finds_flush<M>() || Flushes<M>);
  static constexpr bool finish = !misspells_finish<M>() && (!finds_finish<M>() || Finishes<M>);
  static constexpr bool forget = !misspells_forget<M>() && (!finds_forget<M>() || Forgets<M>);
};

/// How a monitor answers where it need not have a member of this name.
template <class Real> struct MonitorAnswers {
  template <class M> static std::string name(const M& m) { return name_of(m); }
  template <class M> static bool records(const M& /*m*/) {
    return requires(M & m, const Sample& sample) { m.record(sample); };
  }
  template <class M> static bool looks_last(const M& /*m*/) {
    return requires { M::looks_last; };
  }
  template <class M> static bool needs_particles(const M& /*m*/) {
    return requires { M::needs_particles; };
  }
  template <class M> static bool needs_equal_intervals(const M& /*m*/) {
    return requires { M::needs_equal_intervals; };
  }
  template <class M> static void check(const M& m, const ParticleSystem<Real>& s) {
    if constexpr (requires { m.check(s); }) m.check(s);
  }
  template <class M> static Request wanted(const M& m) {
    if constexpr (requires { m.wanted(); }) return m.wanted();
    return {};
  }
  template <class M> static void at_start(M& m, const Snapshot<Real>& start) {
    if constexpr (LooksAtTheStart<M, Real>) m.at_start(start);
  }
  template <class M> static bool looks_at_the_end(const M& /*m*/) { return LooksAtTheEnd<M, Real>; }
  template <class M> static void at_end(M& m, const Snapshot<Real>& end) {
    if constexpr (LooksAtTheEnd<M, Real>) m.at_end(end);
  }
  template <class M> static std::vector<Series> series(const M& m) {
    if constexpr (requires { m.series(); }) return m.series();
    return {};
  }
  template <class M> static std::optional<double> scale(const M& m) {
    if constexpr (requires { m.scale(); }) return m.scale();
    return {};
  }
  template <class M> static std::optional<MonitorReport> report(const M& m) {
    if constexpr (requires { m.report(); }) return m.report();
    return {};
  }
  template <class M> static void record(M& m, const Sample& sample) {
    if constexpr (requires { m.record(sample); }) m.record(sample);
  }
  template <class M> static void flush(M& m) {
    if constexpr (requires { m.flush(); }) m.flush();
  }
  template <class M> static std::int64_t steps_in_a_row(const M& m) {
    if constexpr (requires { m.steps_in_a_row(); }) return m.steps_in_a_row();
    return 1;
  }
  template <class M> static void forget(M& m) {
    if constexpr (requires { m.forget(); }) m.forget();
  }
  template <class M> static void finish(M& m, const Outcome& outcome) {
    if constexpr (requires { m.finish(outcome); }) m.finish(outcome);
  }
  template <class M> static void save(const M& m, SavedState& saved, const std::string& prefix) {
    save_any(saved, prefix, m);
  }
  template <class M> static void load(M& m, const SavedState& saved, const std::string& prefix) {
    load_any(saved, prefix, m);
  }
};

/* The members of AnyMonitor, as `Monitor` tells of them. `check` throws Error if the monitor cannot watch such a state;
   `flush`: writers hand what they have gathered to the file, before a checkpoint counts on it. */
#define NOETHER_MONITOR_SEAM(OWN, ANSWERED)                                                  \
  ANSWERED(std::string, name, () const)                                                      \
  ANSWERED(bool, records, () const)                                                          \
  ANSWERED(bool, looks_last, () const)                                                       \
  ANSWERED(bool, needs_particles, () const)                                                  \
  ANSWERED(bool, needs_equal_intervals, () const)                                            \
  ANSWERED(void, check, (const ParticleSystem<Real>& s) const, s)                            \
  ANSWERED(Request, wanted, () const)                                                        \
  OWN(void, observe, (const Snapshot<Real>& snapshot), snapshot)                             \
  ANSWERED(void, at_start, (const Snapshot<Real>& start), start)                             \
  ANSWERED(bool, looks_at_the_end, () const)                                                 \
  ANSWERED(void, at_end, (const Snapshot<Real>& end), end)                                   \
  ANSWERED(std::vector<Series>, series, () const)                                            \
  ANSWERED(std::optional<double>, scale, () const)                                           \
  ANSWERED(std::optional<MonitorReport>, report, () const)                                   \
  ANSWERED(void, record, (const Sample& sample), sample)                                     \
  ANSWERED(void, flush, ())                                                                  \
  ANSWERED(std::int64_t, steps_in_a_row, () const)                                           \
  ANSWERED(void, forget, ())                                                                 \
  ANSWERED(void, finish, (const Outcome& outcome), outcome)                                  \
  ANSWERED(void, save, (SavedState & saved, const std::string& prefix) const, saved, prefix) \
  ANSWERED(void, load, (const SavedState& saved, const std::string& prefix), saved, prefix)

template <class Real> struct MonitorBase {
  virtual ~MonitorBase() = default;
  NOETHER_MONITOR_SEAM(NOETHER_SEAM_PURE, NOETHER_SEAM_PURE)
};

template <class M, class Real> struct MonitorModel final : MonitorBase<Real> {
  using Members = MonitorMembers<M>;
  using Answers = MonitorAnswers<Real>;
  static_assert(Members::wanted,
                "a monitor has `Request wanted() const`, or no member of that name or nearly that name");
  static_assert(Members::series,
                "a monitor has `std::vector<Series> series() const`, or no member of that name or nearly that name");
  static_assert(Members::scale,
                "a monitor has `std::optional<double> scale() const`, or no member of that name or nearly that name");
  static_assert(Members::report,
                "a monitor has `MonitorReport report() const`, or no member of that name or nearly that name");
  static_assert(Members::record,
                "a monitor has `void record(const Sample&)`, or no member of that name or nearly that name");
  static_assert(Members::flush, "a monitor has `void flush()`, or no member of that name or nearly that name");
  static_assert(Members::finish,
                "a monitor has `void finish(const Outcome&)`, or no member of that name or nearly that name");
  static_assert(!misspells_at_start<M>() && (!finds_at_start<M>() || LooksAtTheStart<M, Real>),
                "a monitor has `void at_start(const Snapshot<Real>&)`, or no member of that name or nearly that name");
  static_assert(!misspells_at_end<M>() && (!finds_at_end<M>() || LooksAtTheEnd<M, Real>),
                "a monitor has `void at_end(const Snapshot<Real>&)`, or no member of that name or nearly that name");
  static_assert(Members::forget, "a monitor has `void forget()`, or no member of that name or nearly that name");
  explicit MonitorModel(M m) : held(std::move(m)) {}
  NOETHER_MONITOR_SEAM(NOETHER_SEAM_HELD, NOETHER_SEAM_ANSWERED)
  M held;
};

}  // namespace detail

/// Any monitor over one number type: the fourth erased seam. It owns the monitor and never moves it.
template <class Real = double> class AnyMonitor {
 public:
  template <class M>
    requires(!std::is_same_v<M, AnyMonitor> && Monitor<M, Real>)
  AnyMonitor(M monitor)  // NOLINT: erases on purpose
      : held_(std::make_unique<detail::MonitorModel<M, Real>>(std::move(monitor))) {}

  NOETHER_MONITOR_SEAM(NOETHER_SEAM_CALL, NOETHER_SEAM_CALL)

  /// The monitor itself, when its type is known; null otherwise.
  template <class M> M* get() {
    auto* model = dynamic_cast<detail::MonitorModel<M, Real>*>(held_.get());
    return model == nullptr ? nullptr : &model->held;
  }

 private:
  std::unique_ptr<detail::MonitorBase<Real>> held_;
};

}  // namespace noether
