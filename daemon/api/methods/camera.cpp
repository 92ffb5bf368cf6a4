/// Images between the jobs.

#include "daemon/api/methods/device_task.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/jobs/device_commands.hpp"

namespace fvd {

namespace {

struct ExposureParams {
  ImageParams image;
  double target = 0.8;

  void describe(Fields& fields) {
    image.describe(fields);
    fields.number("target", target, {0.1, 0.95}, "wanted brightness of the brightest 0.1 %, of full scale");
  }
};

void describe_snap(Fields& fields) {
  const ResultFields result(fields);
  result.text("path", "the PNG, 8 or 16 bit; the newest hundred are kept");
  result.integer("width_px", "of the image");
  result.integer("height_px", "of the image");
  result.integer("bits", "significant ones per pixel");
  result.number("exposure_us", "in force");
  result.number("gain_db", "in force");
  result.number("z_um", "mean position of the stage during the exposure");
  result.any("grey", "an object: min, max, mean, p01, p50, p99, p999, saturated_fraction");
}

void describe_preview(Fields& fields) {
  const ResultFields result(fields);
  result.integer("seq", "counts pictures");
  result.integer("width_px", "at most 640");
  result.integer("height_px", "at most 480");
  result.number("z_um", "position of the stage");
  result.number("focus", "sharpness of the middle of the image, grey levels");
  result.number("saturated_fraction", "of the pixels");
  result.text("png_base64", "the picture");
}

void describe_exposure(Fields& fields) {
  const ResultFields result(fields);
  result.number("exposure_us", "the last one tried");
  result.boolean("reached", "it is right within 5 %");
  result.integer("looks", "images taken, at most 8");
  result.any("grey", "an object as that of camera.snap");
}

const std::vector<ErrorCode> kImageErrors{
    ErrorCode::kUnknownRecipe, ErrorCode::kBadRecipe,      ErrorCode::kCameraDisconnected, ErrorCode::kCameraFramesLost,
    ErrorCode::kCameraTimeout, ErrorCode::kCameraSettings, ErrorCode::kCameraNoFrames};

}  // namespace

void add_camera_methods(MethodTable& methods, const Services& services) {
  auto snap_errors = kImageErrors;
  snap_errors.push_back(ErrorCode::kStorageWrite);
  methods["camera.snap"] = {
      .about = task_description("Takes one image, writes it as PNG in <state_dir>/snaps, and tells its grey levels",
                                described<ImageParams>(), describe_snap, snap_errors, TaskMotion::kNone),
      .run = with<ImageParams>([services](const Call& call, const ImageParams& params) -> Answer {
        require_wait(call);
        return reply_when_done(services.tasks.submit(snap_work(params.settings(services.recipes)), TaskMotion::kNone));
      })};
  methods["camera.preview"] = {
      .about = task_description("A picture for the eye: one taken now, or the newest slice of the job that runs",
                                described<ImageParams>(), describe_preview, kImageErrors, TaskMotion::kNone),
      .run = with<ImageParams>([services](const Call& call, const ImageParams& params) -> Answer {
        require_wait(call);
        return reply_when_done(services.tasks.preview(params.settings(services.recipes)));
      })};
  methods["camera.suggest_exposure"] = {
      .about = task_description("Seeks the exposure; the camera has the asked settings afterwards",
                                described<ExposureParams>(), describe_exposure, kImageErrors, TaskMotion::kNone),
      .run = with<ExposureParams>([services](const Call& call, const ExposureParams& params) -> Answer {
        require_wait(call);
        return reply_when_done(services.tasks.submit(
            exposure_work(params.image.settings(services.recipes), params.target), TaskMotion::kNone));
      })};
}

}  // namespace fvd
