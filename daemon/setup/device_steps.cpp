/// Which camera, which drive, by which profile; the reference.

#include <algorithm>
#include <sstream>
#include <system_error>

#include "core/base/error.hpp"
#include "daemon/setup/setup_step.hpp"
#include "drivers/modbus/drive_check.hpp"
#include "drivers/modbus/modbus_axis.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

bool by_profile(SetupContext& context) { return context.draft.devices.stage.driver == "modbus"; }

// Camera.

std::string camera_line(const FoundCamera& camera) {
  std::string line = camera.vendor + " " + camera.model + ", serial " + camera.serial + ", at " + camera.address;
  if (!camera.user_name.empty()) line += ", called " + camera.user_name;
  if (camera.control == CameraControl::kControlled) line += ", controlled by another program";
  if (!camera.subnet_fits) line += ", in another subnet than " + camera.interface + ": see fvdctl camera set-ip";
  return line;
}

SetupQuestion ask_camera(SetupContext& context) {
  SetupQuestion question;
  question.text = context.cameras.empty() ? "No camera answers the search. Which one is it?" : "Which camera is it?";
  for (std::size_t i = 0; i < context.cameras.size(); ++i) {
    question.choices.push_back({std::to_string(i + 1), camera_line(context.cameras[i]), false});
  }
  question.choices.push_back(
      {"ADDRESS", "the camera of this IP address, serial number, MAC, name or vendor-model-serial", false});
  question.choices.push_back({"search", "looks for cameras", false});
  return question;
}

SetupNext take_camera(SetupContext& context, const SetupAnswer& answer) {
  if (answer.size() != 1) refuse_answer(answer);
  if (answer.is("search")) {
    search_cameras(context);
    return SetupNext::kStay;
  }
  std::string address = answer.text();
  for (std::size_t i = 0; i < context.cameras.size(); ++i) {
    if (answer.is(std::to_string(i + 1))) address = context.cameras[i].address;
  }
  CameraConfig& camera = context.draft.devices.camera;
  camera.driver = "aravis";
  camera.address = address;
  camera.serial.clear();
  camera.packet_socket = !address.starts_with("127.");  // it sees frames of the loopback twice
  const CameraInfo info = context.bench.camera(camera).info();
  camera.serial = info.serial;  // no other one from now on
  context.note = "camera " + info.vendor + " " + info.model + ", serial " + info.serial + ", sensor " +
                 std::to_string(info.sensor_width) + " x " + std::to_string(info.sensor_height) + " pixels";
  return SetupNext::kOn;
}

// Line.

SetupQuestion ask_line(SetupContext& /*context*/) {
  SetupQuestion question;
  question.text = "How is the drive of the Z stage reached?";
  question.choices = {{"tcp HOST[:PORT]", "Modbus TCP, or a controller of Physik Instrumente (port 50000)", false},
                      {"serial DEVICE [BAUD [PARITY]]",
                       "a serial port, best by its name in /dev/serial/by-id; without more: 115200 even", false}};
  return question;
}

void take_tcp(StageConfig& stage, const SetupAnswer& answer) {
  const std::string& where = answer.word(1);
  const auto colon = where.rfind(':');
  stage.transport = "tcp";
  stage.port = StageConfig().port;
  stage.address = where.substr(0, colon);
  if (stage.address.empty()) refuse_answer(answer);
  if (colon != std::string::npos) {
    stage.port = static_cast<int>(SetupAnswer(where.substr(colon + 1)).number(0, 1, 65535, "port"));
  }
}

SetupNext take_line(SetupContext& context, const SetupAnswer& answer) {
  StageConfig& stage = context.draft.devices.stage;
  if (answer.begins("tcp", 2)) {
    take_tcp(stage, answer);
    return SetupNext::kOn;
  }
  if (answer.word(0) != "serial" || answer.size() < 2 || answer.size() > 4) refuse_answer(answer);
  stage.transport = "rtu";
  stage.serial_device = answer.word(1);
  stage.serial_baud = StageConfig().serial_baud;
  stage.serial_parity = StageConfig().serial_parity;
  if (answer.size() > 2) stage.serial_baud = static_cast<int>(answer.number(2, 9600, 921600, "baud rate"));
  if (answer.size() > 3) stage.serial_parity = answer.word(3);
  if (stage.serial_parity != "none" && stage.serial_parity != "even" && stage.serial_parity != "odd") {
    throw Error(ErrorCode::kBadInput, "'" + stage.serial_parity + "' is no parity; expected none, even or odd");
  }
  return SetupNext::kOn;
}

// Profile, unit, scale.

std::vector<fs::path> profiles_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == ".json") files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

SetupQuestion ask_profile(SetupContext& context) {
  SetupQuestion question;
  question.text = "Which drive is it?";
  const auto files = profiles_in(context.options.drives);
  for (std::size_t i = 0; i < files.size(); ++i) {
    question.choices.push_back({std::to_string(i + 1), "the profile " + files[i].string(), false});
  }
  question.choices.push_back({"FILE", "this drive profile", false});
  question.choices.push_back({"gcs AXIS", "a controller of Physik Instrumente; AXIS as it calls it, e.g. 1", false});
  return question;
}

SetupNext take_profile(SetupContext& context, const SetupAnswer& answer) {
  StageConfig& stage = context.draft.devices.stage;
  if (answer.begins("gcs", 2)) {
    stage.driver = "gcs";
    stage.gcs_axis = answer.word(1);
    if (stage.transport != "tcp") stage.transport = "serial";
    return SetupNext::kOn;
  }
  if (answer.text().empty()) refuse_answer(answer);
  fs::path file = answer.text();
  const auto files = profiles_in(context.options.drives);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (answer.is(std::to_string(i + 1))) file = files[i];
  }
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw Error(ErrorCode::kBadInput,
                "there is no file '" + file.string() + "'; expected a number of the list or a file");
  }
  (void)load_drive_profile(file);
  stage.driver = "modbus";
  stage.profile = fs::absolute(file).lexically_normal();
  if (stage.transport == "serial") stage.transport = "rtu";
  return SetupNext::kOn;
}

SetupQuestion ask_unit(SetupContext& /*context*/) {
  SetupQuestion question;
  question.text = "Which Modbus unit is the drive? Its registers are read then, and none is written.";
  question.choices = {{"UNIT", "1 to 247; 1 is what most drives are delivered with", false}};
  return question;
}

SetupNext take_unit(SetupContext& context, const SetupAnswer& answer) {
  StageConfig& stage = context.draft.devices.stage;
  if (answer.size() != 1) refuse_answer(answer);
  stage.unit = static_cast<int>(answer.number(0, 1, 247, "unit"));
  context.bench.close_stage();
  const DriveProfile profile = load_drive_profile(stage.profile);
  ModbusLink link(modbus_link_config(stage));
  const DriveCheck check = check_drive(profile, link);
  if (!check.disagreements.empty()) {
    std::string message = "the drive at " + link.description() + " is not what the profile " + profile.name + " says";
    for (const std::string& one : check.disagreements) message += "; " + one;
    throw Error(ErrorCode::kStageDisconnected, message + ". Another unit, or back for another profile");
  }
  context.note = "the drive at " + link.description() + " fits the profile " + profile.name;
  if (!check.alarm.empty()) context.note += ", and reports " + check.alarm;
  return SetupNext::kOn;
}

SetupQuestion ask_scale(SetupContext& context) {
  const DriveProfile profile = load_drive_profile(context.draft.devices.stage.profile);
  std::ostringstream text;
  text << "The profile counts " << profile.steps_per_um << " steps and " << profile.counts_per_um
       << " counts of the encoder per um. Is that so for this screw and this gear? If not, every distance is wrong by "
          "the same factor: copy the profile, correct scale and feedback, and choose the copy.";
  SetupQuestion question;
  question.text = text.str();
  question.choices = {{"yes", "so it is", false}};
  return question;
}

SetupNext take_scale(SetupContext& /*context*/, const SetupAnswer& answer) {
  if (!answer.is("yes")) refuse_answer(answer);
  return SetupNext::kOn;
}

// Travel and reference.

SetupQuestion ask_travel(SetupContext& /*context*/) {
  SetupQuestion question;
  question.text =
      "Between which positions may the axis move while it is set up? They lie within the drive's own limits of travel, "
      "where it has such. The limits for measuring are taught afterwards.";
  question.choices = {{"LOWEST HIGHEST", "in um, e.g. -10000 10000", false}};
  return question;
}

SetupNext take_travel(SetupContext& context, const SetupAnswer& answer) {
  if (answer.size() != 2) refuse_answer(answer);
  StageConfig& stage = context.draft.devices.stage;
  stage.min = Micrometers{answer.number(0, -1e6, 1e6, "position in um")};
  stage.max = Micrometers{answer.number(1, -1e6, 1e6, "position in um")};
  if (!(stage.min < stage.max)) throw Error(ErrorCode::kBadInput, "the lowest position is not below the highest");
  return SetupNext::kOn;
}

SetupQuestion ask_reference(SetupContext& /*context*/) {
  SetupQuestion question;
  question.text =
      "Take the part away and bring the lens far from everything, by hand if need be. The axis needs a reference: "
      "homing MOVES it to its reference switch, in the direction that is set in the drive. The motor gets no torque "
      "before the first motion: hold a vertical axis that has no brake.";
  question.choices = {{"home", "enables the motor and homes the axis", true},
                      {"keep", "the axis has a reference already; nothing is enabled, and nothing moves", false}};
  return question;
}

SetupNext take_reference(SetupContext& context, const SetupAnswer& answer) {
  const StageConfig& stage = context.draft.devices.stage;
  if (answer.is("home")) {
    context.bench.moving_stage(stage).home(context.stop);
  } else if (!answer.is("keep")) {
    refuse_answer(answer);
  }
  const StageStatus status = context.bench.stage(stage).status();
  if (!status.homed) {
    throw Error(ErrorCode::kStageNotHomed, "the axis has no reference: home it");
  }
  context.note = "the axis has its reference and stands at " + um_text(status.position.value);
  return SetupNext::kOn;
}

}  // namespace

void search_cameras(SetupContext& context) {
  try {
    context.cameras = context.options.find_cameras ? context.options.find_cameras() : std::vector<FoundCamera>{};
    context.note = std::to_string(context.cameras.size()) + " found";
  } catch (const Error& error) {
    context.note = error.what();
  }
}

std::vector<SetupStep> device_steps() {
  return {{"camera", nullptr, ask_camera, take_camera},         {"line", nullptr, ask_line, take_line},
          {"profile", nullptr, ask_profile, take_profile},      {"unit", by_profile, ask_unit, take_unit},
          {"scale", by_profile, ask_scale, take_scale},         {"travel", nullptr, ask_travel, take_travel},
          {"reference", nullptr, ask_reference, take_reference}};
}

}  // namespace fvd
