#include "daemon/setup/setup.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <sstream>
#include <tuple>
#include <utility>

#include "core/base/error.hpp"
#include "daemon/setup/setup_files.hpp"
#include "daemon/setup/setup_step.hpp"

namespace fvd {

namespace {

using namespace std::string_view_literals;

std::vector<SetupStep> all_steps() {
  std::vector<SetupStep> all;
  for (const auto& part : {device_steps(), axis_steps(), picture_steps(), last_steps()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1));
}

}  // namespace

SetupAnswer::SetupAnswer(std::string_view text) : text_(trimmed(text)) {
  std::istringstream in(text_);
  words_.assign(std::istream_iterator<std::string>(in), {});
}

const std::string& SetupAnswer::word(std::size_t index) const {
  static const std::string kNone;
  return index < words_.size() ? words_[index] : kNone;
}

bool SetupAnswer::begins(std::string_view first, std::size_t count) const {
  return words_.size() == count && words_.front() == first;
}

double SetupAnswer::number(std::size_t index, double least, double most, std::string_view what) const {
  const std::string& digits = word(index);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc() && end == digits.data() + digits.size() && value >= least && value <= most) return value;
  std::ostringstream message;
  message << "'" << digits << "' is no " << what << "; expected a number from " << least << " to " << most;
  throw Error(ErrorCode::kBadInput, message.str());
}

void refuse_answer(const SetupAnswer& answer) {
  throw Error(ErrorCode::kBadInput, answer.text().empty() ? "nothing was answered; nothing was done"
                                                          : "'" + answer.text() + "' is none of the answers");
}

std::string um_text(double um) {
  std::ostringstream text;
  text.precision(4);
  text << um << " um";
  return text.str();
}

struct Setup::Impl {
  Impl(SetupOptions with, std::stop_token stop)
      : options(std::move(with)), bench(options.pictures), context{options, bench, {}, {}, {}, {}, std::move(stop)} {
    context.draft.devices = older_devices(options.file);
    context.draft.devices.camera.simulated = options.simulated;
    context.draft.devices.stage.simulated = options.simulated;
    search_cameras(context);
    ask();
  }

  /// The first step from there on that is to be asked; the number of steps where there is none.
  [[nodiscard]] std::size_t next_wanted(std::size_t from) {
    while (from < steps.size() && steps[from].wanted != nullptr && !steps[from].wanted(context)) ++from;
    return from;
  }

  void ask() {
    const SetupStep& step = steps[index];
    question = step.ask(context);
    question.step = step.name;
    question.note = std::exchange(context.note, {});
    question.picture = bench.picture();
    if (!earlier.empty()) question.choices.push_back({"back", "takes the answer before back", false});
  }

  /// A question that cannot be made anew stays as it was shown, with the note.
  void ask_again() {
    try {
      ask();
    } catch (const Error&) {
      question.note = std::exchange(context.note, {});
    }
  }

  /// The reference is asked for by a later step, and that step comes next.
  [[nodiscard]] bool in_between() const { return !earlier.empty() && earlier.back().first > index; }

  void step_back() {
    index = earlier.back().first;
    earlier.pop_back();
  }

  void go_back() {
    if (earlier.empty()) throw Error(ErrorCode::kBadInput, "this is the first question");
    context.draft = earlier.back().second;
    step_back();
  }

  void take(const SetupAnswer& answer) {
    const SetupDraft before = context.draft;
    switch (steps[index].take(context, answer)) {
      case SetupNext::kStay:
        return;
      case SetupNext::kStepBack:
        step_back();
        return;
      case SetupNext::kOn: {
        if (in_between()) {
          step_back();
          return;
        }
        const std::size_t next = next_wanted(index + 1);
        earlier.emplace_back(index, before);
        index = next;
        context.draft.seen_px.reset();
        return;
      }
    }
  }

  /// An axis without a reference is asked for one, and then the step that needs it again.
  void ask_for_reference() {
    if (index == reference) return;
    earlier.emplace_back(index, context.draft);
    index = reference;
  }

  const SetupOptions options;
  SetupBench bench;
  SetupContext context;
  const std::vector<SetupStep> steps = all_steps();
  const std::size_t reference = static_cast<std::size_t>(
      std::find_if(steps.begin(), steps.end(), [](const SetupStep& step) { return step.name == "reference"sv; }) -
      steps.begin());
  std::size_t index = 0;
  std::vector<std::pair<std::size_t, SetupDraft>> earlier;  // steps that were answered, with the draft before each
  SetupQuestion question;
  bool refused = false;
};

Setup::Setup(SetupOptions options, std::stop_token stop)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(stop))) {}
Setup::~Setup() = default;

const SetupQuestion& Setup::question() const { return impl_->question; }

void Setup::answer(std::string_view text) {
  Impl& impl = *impl_;
  const SetupAnswer answer(text);
  impl.refused = false;
  const auto before = std::tuple(impl.index, impl.earlier, impl.context.draft);
  impl.bench.permit_motion(moves_the_axis(impl.question, answer.text()));
  try {
    if (answer.is("back")) {
      impl.go_back();
    } else {
      impl.take(answer);
    }
    impl.bench.permit_motion(false);
    if (!done()) impl.ask();
  } catch (const Error& error) {
    impl.bench.permit_motion(false);
    if (error.code() == ErrorCode::kAborted || error.code() == ErrorCode::kInternal) throw;
    std::tie(impl.index, impl.earlier, impl.context.draft) = before;
    impl.refused = true;
    impl.context.note = error.what();
    if (error.code() == ErrorCode::kStageNotHomed) impl.ask_for_reference();
    impl.ask_again();
  }
}

bool Setup::refused() const { return impl_->refused; }

bool Setup::done() const { return impl_->index >= impl_->steps.size(); }

const std::filesystem::path& Setup::written() const { return impl_->context.written; }

const std::string& Setup::report() const { return impl_->context.note; }

}  // namespace fvd
