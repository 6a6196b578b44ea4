#pragma once
/// Monitors and writers: what watches a run. They see settled copies and cannot change the trajectory.

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

template <class Real> struct MonitorBase {
  virtual ~MonitorBase() = default;
  virtual std::string name() const = 0;
  virtual bool records() const = 0;
  virtual bool looks_last() const = 0;
  virtual bool needs_particles() const = 0;
  virtual bool needs_equal_intervals() const = 0;
  virtual void check(const ParticleSystem<Real>&) const = 0;
  virtual Request wanted() const = 0;
  virtual void observe(const Snapshot<Real>&) = 0;
  virtual void at_start(const Snapshot<Real>&) = 0;
  virtual bool looks_at_the_end() const = 0;
  virtual void at_end(const Snapshot<Real>&) = 0;
  virtual std::vector<Series> series() const = 0;
  virtual std::optional<double> scale() const = 0;
  virtual std::optional<MonitorReport> report() const = 0;
  virtual void record(const Sample&) = 0;
  virtual void flush() = 0;
  virtual std::int64_t steps_in_a_row() const = 0;
  virtual void forget() = 0;
  virtual void finish(const Outcome&) = 0;
  virtual void save(SavedState&, const std::string&) const = 0;
  virtual void load(const SavedState&, const std::string&) = 0;
};

template <class M, class Real> struct MonitorModel final : MonitorBase<Real> {
  using Members = MonitorMembers<M>;
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
  explicit MonitorModel(M m) : monitor(std::move(m)) {}
  std::string name() const override { return name_of(monitor); }
  bool records() const override {
    return requires(M & m, const Sample& s) { m.record(s); };
  }
  bool looks_last() const override {
    return requires { M::looks_last; };
  }
  bool needs_particles() const override {
    return requires { M::needs_particles; };
  }
  bool needs_equal_intervals() const override {
    return requires { M::needs_equal_intervals; };
  }
  void check(const ParticleSystem<Real>& s) const override {
    if constexpr (requires { monitor.check(s); }) monitor.check(s);
  }
  Request wanted() const override {
    if constexpr (requires { monitor.wanted(); }) return monitor.wanted();
    return {};
  }
  void observe(const Snapshot<Real>& snapshot) override { monitor.observe(snapshot); }
  void at_start(const Snapshot<Real>& start) override {
    if constexpr (LooksAtTheStart<M, Real>) monitor.at_start(start);
  }
  bool looks_at_the_end() const override { return LooksAtTheEnd<M, Real>; }
  void at_end(const Snapshot<Real>& end) override {
    if constexpr (LooksAtTheEnd<M, Real>) monitor.at_end(end);
  }
  std::vector<Series> series() const override {
    if constexpr (requires { monitor.series(); }) return monitor.series();
    return {};
  }
  std::optional<double> scale() const override {
    if constexpr (requires { monitor.scale(); }) return monitor.scale();
    return {};
  }
  std::optional<MonitorReport> report() const override {
    if constexpr (requires { monitor.report(); }) return monitor.report();
    return {};
  }
  void record(const Sample& sample) override {
    if constexpr (requires { monitor.record(sample); }) monitor.record(sample);
  }
  void flush() override {
    if constexpr (requires { monitor.flush(); }) monitor.flush();
  }
  std::int64_t steps_in_a_row() const override {
    if constexpr (requires { monitor.steps_in_a_row(); }) return monitor.steps_in_a_row();
    return 1;
  }
  void forget() override {
    if constexpr (requires { monitor.forget(); }) monitor.forget();
  }
  void finish(const Outcome& outcome) override {
    if constexpr (requires { monitor.finish(outcome); }) monitor.finish(outcome);
  }
  void save(SavedState& saved, const std::string& prefix) const override { save_any(saved, prefix, monitor); }
  void load(const SavedState& saved, const std::string& prefix) override { load_any(saved, prefix, monitor); }
  M monitor;
};

}  // namespace detail

/// Any monitor over one number type: the fourth erased seam. It owns the monitor and never moves it.
template <class Real = double> class AnyMonitor {
 public:
  template <class M>
    requires(!std::is_same_v<M, AnyMonitor> && Monitor<M, Real>)
  AnyMonitor(M monitor)  // NOLINT: erases on purpose
      : held_(std::make_unique<detail::MonitorModel<M, Real>>(std::move(monitor))) {}

  std::string name() const { return held_->name(); }
  bool records() const { return held_->records(); }
  bool looks_last() const { return held_->looks_last(); }
  bool needs_particles() const { return held_->needs_particles(); }
  bool needs_equal_intervals() const { return held_->needs_equal_intervals(); }
  /// @throws Error  if a monitor says that it cannot watch such a state
  void check(const ParticleSystem<Real>& s) const { held_->check(s); }
  Request wanted() const { return held_->wanted(); }
  void observe(const Snapshot<Real>& snapshot) { held_->observe(snapshot); }
  void at_start(const Snapshot<Real>& start) { held_->at_start(start); }
  bool looks_at_the_end() const { return held_->looks_at_the_end(); }
  void at_end(const Snapshot<Real>& end) { held_->at_end(end); }
  std::vector<Series> series() const { return held_->series(); }
  std::optional<double> scale() const { return held_->scale(); }
  std::optional<MonitorReport> report() const { return held_->report(); }
  void record(const Sample& sample) { held_->record(sample); }
  /// Writers hand what they have gathered to the file, before a checkpoint counts on it.
  void flush() { held_->flush(); }
  std::int64_t steps_in_a_row() const { return held_->steps_in_a_row(); }
  void forget() { held_->forget(); }
  void finish(const Outcome& outcome) { held_->finish(outcome); }
  void save(SavedState& saved, const std::string& prefix) const { held_->save(saved, prefix); }
  void load(const SavedState& saved, const std::string& prefix) { held_->load(saved, prefix); }

  /// The monitor itself, when its type is known; null otherwise.
  template <class M> M* get() {
    auto* model = dynamic_cast<detail::MonitorModel<M, Real>*>(held_.get());
    return model == nullptr ? nullptr : &model->monitor;
  }

 private:
  std::unique_ptr<detail::MonitorBase<Real>> held_;
};

}  // namespace noether
