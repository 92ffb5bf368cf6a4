#include "daemon/jobs/control_lease.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "daemon/access/access_error.hpp"

namespace fvd {
namespace {

using std::chrono::seconds;

/// The code with which the action is refused; nothing if it is not.
template <typename Action>
std::optional<AccessCode> refusal_of(Action action) {
  try {
    action();
  } catch (const AccessError& error) {
    return error.code();
  }
  return std::nullopt;
}

class AControlLease : public testing::Test {
 protected:
  ControlLease::Holder acquire(const Identity& who, bool force = false) {
    return lease_.acquire({who, "owner of " + who.name, seconds(60), force});
  }

  HostTime now_{};
  bool job_runs_ = false;
  ControlLease lease_{[this] { return now_; }, [this] { return job_runs_; }};
  const Identity plc_{"address 10.0.0.7", Role::kOperate};
  const Identity page_{"token kiosk", Role::kOperate};
  const Identity root_{"uid 0", Role::kAdminister};
};

TEST_F(AControlLease, LetsEverybodyWorkUntilSomebodyHoldsIt) {
  EXPECT_NO_THROW(lease_.require(page_.name));
  EXPECT_FALSE(lease_.holder());
  acquire(plc_);
  EXPECT_NO_THROW(lease_.require(plc_.name));
  EXPECT_EQ(refusal_of([&] { lease_.require(page_.name); }), AccessCode::kNoControl);
  EXPECT_EQ(refusal_of([&] { lease_.require(root_.name); }), AccessCode::kNoControl);
  EXPECT_EQ(lease_.holder()->owner, "owner of address 10.0.0.7");
  lease_.release(page_.name);
  EXPECT_TRUE(lease_.holder()) << "it is not the page's to give up";
  lease_.release(plc_.name);
  EXPECT_NO_THROW(lease_.require(page_.name));
}

TEST_F(AControlLease, EndsByItselfAndIsRenewedByItsHolder) {
  acquire(plc_);
  now_ += seconds(59);
  EXPECT_EQ(acquire(plc_).until, now_ + seconds(60));
  now_ += seconds(59);
  EXPECT_EQ(refusal_of([&] { acquire(page_); }), AccessCode::kNoControl);
  now_ += seconds(1);
  EXPECT_FALSE(lease_.holder());
  EXPECT_NO_THROW(acquire(page_));
  EXPECT_EQ(refusal_of([&] { lease_.require(plc_.name); }), AccessCode::kNoControl);
}

TEST_F(AControlLease, OutlastsItsTimeWhileAJobRuns) {
  acquire(plc_);
  now_ += seconds(61);
  job_runs_ = true;
  EXPECT_EQ(refusal_of([&] { acquire(page_); }), AccessCode::kNoControl);
  EXPECT_EQ(refusal_of([&] { lease_.require(page_.name); }), AccessCode::kNoControl);
  EXPECT_EQ(lease_.holder()->who, plc_.name);
  job_runs_ = false;
  EXPECT_NO_THROW(acquire(page_));
}

TEST_F(AControlLease, IsGivenToNobodyWhileAJobRunsThatWasStartedWithoutIt) {
  job_runs_ = true;
  EXPECT_THROW(acquire(page_), Error);
  EXPECT_NO_THROW(lease_.require(plc_.name));
  job_runs_ = false;
  EXPECT_NO_THROW(acquire(page_));
}

TEST_F(AControlLease, IsTakenByForceOnlyByWhoAdministersAndNeverWhileAJobRuns) {
  acquire(plc_);
  EXPECT_EQ(refusal_of([&] { acquire(page_, true); }), AccessCode::kNotAllowed);
  job_runs_ = true;
  EXPECT_THROW(acquire(root_, true), Error);
  EXPECT_NO_THROW(acquire(plc_)) << "the holder renews it in its job too";
  job_runs_ = false;
  acquire(root_, true);
  EXPECT_EQ(refusal_of([&] { lease_.require(plc_.name); }), AccessCode::kNoControl);
}

TEST_F(AControlLease, TellsOfEveryChange) {
  int told = 0;
  lease_.on_change([&told] { ++told; });
  acquire(plc_);
  EXPECT_EQ(told, 1);
  acquire(plc_);
  EXPECT_EQ(told, 2) << "renewed";
  EXPECT_EQ(refusal_of([&] { acquire(page_); }), AccessCode::kNoControl);
  lease_.release(page_.name);
  EXPECT_EQ(told, 2) << "nothing changed";
  lease_.release(plc_.name);
  EXPECT_EQ(told, 3);
  lease_.on_change({});
  acquire(page_);
  EXPECT_EQ(told, 3);
}

}  // namespace
}  // namespace fvd
