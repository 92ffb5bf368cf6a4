#include "sim/camera/genicam_xml.hpp"

#include <sstream>
#include <vector>

#include "sim/camera/camera_registers.hpp"
#include "sim/camera/gvcp.hpp"

namespace fvd::sim {

namespace {

/// Builds the XML node by node, so that a feature and its register stay together.
class Description {
 public:
  void category(const std::string& name, const std::vector<std::string>& members) {
    out_ << "<Category Name=\"" << name << "\" NameSpace=\"Standard\">";
    for (const auto& member : members) out_ << "<pFeature>" << member << "</pFeature>";
    out_ << "</Category>\n";
  }

  void integer(const std::string& name, std::uint32_t address, const std::string& access, const std::string& limits) {
    out_ << "<Integer Name=\"" << name << "\" NameSpace=\"Standard\"><pValue>" << name << "Reg</pValue>" << limits
         << "</Integer>\n";
    int_register(name + "Reg", address, access);
  }

  void number(const std::string& name, std::uint32_t address, double min, double max, const std::string& unit) {
    out_ << "<Float Name=\"" << name << "\" NameSpace=\"Standard\"><pValue>" << name << "Reg</pValue><Min>" << min
         << "</Min><Max>" << max << "</Max><Unit>" << unit << "</Unit></Float>\n<FloatReg Name=\"" << name
         << "Reg\" NameSpace=\"Custom\"><Address>" << address
         << "</Address><Length>8</Length><AccessMode>RW</AccessMode>"
         << "<pPort>Device</pPort><Endianess>BigEndian</Endianess></FloatReg>\n";
  }

  /// A value that is the first less the second.
  void difference(const std::string& name, const std::string& first, const std::string& second) {
    out_ << "<IntSwissKnife Name=\"" << name << "\" NameSpace=\"Custom\"><pVariable Name=\"FIRST\">" << first
         << "</pVariable><pVariable Name=\"SECOND\">" << second
         << "</pVariable><Formula>FIRST - SECOND</Formula></IntSwissKnife>\n";
  }

  struct Entry {
    std::string name;
    std::uint32_t value;
  };
  void enumeration(const std::string& name, std::uint32_t address, const std::vector<Entry>& entries) {
    out_ << "<Enumeration Name=\"" << name << "\" NameSpace=\"Standard\">";
    for (const Entry& entry : entries) {
      out_ << "<EnumEntry Name=\"" << entry.name << "\" NameSpace=\"Standard\"><Value>" << entry.value
           << "</Value></EnumEntry>";
    }
    out_ << "<pValue>" << name << "Reg</pValue></Enumeration>\n";
    int_register(name + "Reg", address, "RW");
  }

  void boolean(const std::string& name, std::uint32_t address) {
    out_ << "<Boolean Name=\"" << name << "\" NameSpace=\"Standard\"><pValue>" << name
         << "Reg</pValue><OnValue>1</OnValue><OffValue>0</OffValue></Boolean>\n";
    int_register(name + "Reg", address, "RW");
  }

  void command(const std::string& name, std::uint32_t address, std::uint32_t value = 1) {
    out_ << "<Command Name=\"" << name << "\" NameSpace=\"Standard\"><pValue>" << name << "Reg</pValue><CommandValue>"
         << value << "</CommandValue></Command>\n";
    int_register(name + "Reg", address, "WO");
  }

  /// An integer in the low half of a register.
  void half(const std::string& name, std::uint32_t address, const std::string& limits) {
    out_ << "<Integer Name=\"" << name << "\" NameSpace=\"Standard\"><pValue>" << name << "Reg</pValue>" << limits
         << "</Integer>\n<MaskedIntReg Name=\"" << name << "Reg\" NameSpace=\"Custom\"><Address>" << address
         << "</Address><Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort><Cachable>NoCache</Cachable>"
         << "<LSB>31</LSB><MSB>16</MSB><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></MaskedIntReg>\n";
  }

  void text(const std::string& name, std::uint32_t address, std::size_t length, const std::string& access = "RO") {
    out_ << "<StringReg Name=\"" << name << "\" NameSpace=\"Standard\"><Address>" << address << "</Address><Length>"
         << length << "</Length><AccessMode>" << access << "</AccessMode><pPort>Device</pPort></StringReg>\n";
  }

  void wide(const std::string& name, std::uint32_t address) {
    out_ << "<IntReg Name=\"" << name << "\" NameSpace=\"Standard\"><Address>" << address
         << "</Address><Length>8</Length><AccessMode>RO</AccessMode><pPort>Device</pPort><Cachable>NoCache</Cachable>"
         << "<Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></IntReg>\n";
  }

  [[nodiscard]] std::string finished() const {
    return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
           "<RegisterDescription ModelName=\"SimulatedCamera\" VendorName=\"fvd\" ToolTip=\"Simulated camera of fvd\" "
           "StandardNameSpace=\"GEV\" SchemaMajorVersion=\"1\" SchemaMinorVersion=\"1\" SchemaSubMinorVersion=\"0\" "
           "MajorVersion=\"1\" MinorVersion=\"0\" SubMinorVersion=\"0\" "
           "ProductGuid=\"5f6a3c1e-0000-4000-8000-667664736d31\" VersionGuid=\"5f6a3c1e-0001-4000-8000-667664736d31\" "
           "xmlns=\"http://www.genicam.org/GenApi/Version_1_1\" "
           "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
           "xsi:schemaLocation=\"http://www.genicam.org/GenApi/Version_1_1 GenApiSchema_Version_1_1.xsd\">\n" +
           out_.str() + "<Port Name=\"Device\" NameSpace=\"Standard\"/>\n</RegisterDescription>\n";
  }

 private:
  void int_register(const std::string& name, std::uint32_t address, const std::string& access) {
    out_ << "<IntReg Name=\"" << name << "\" NameSpace=\"Custom\"><Address>" << address
         << "</Address><Length>4</Length><AccessMode>" << access
         << "</AccessMode><pPort>Device</pPort><Cachable>NoCache</Cachable><Sign>Unsigned</Sign>"
         << "<Endianess>BigEndian</Endianess></IntReg>\n";
  }

  std::ostringstream out_;
};

}  // namespace

std::string genicam_xml(const DescriptionOptions& options) {
  const std::string across_increment = "<Inc>" + std::to_string(options.width_increment) + "</Inc>";
  namespace reg = gvcp::reg;
  Description d;
  std::vector<std::string> categories{"DeviceControl", "ImageFormatControl", "AcquisitionControl", "AnalogControl",
                                      "TransportLayerControl"};
  if (options.chunk_mode) categories.emplace_back("ChunkDataControl");
  d.category("Root", categories);
  d.category("DeviceControl", {"DeviceVendorName", "DeviceModelName", "DeviceVersion", "DeviceSerialNumber",
                               "DeviceUserID", "TimestampLatch", "TimestampLatchValue"});
  d.text("DeviceVendorName", reg::kManufacturer, 32);
  d.text("DeviceModelName", reg::kModel, 32);
  d.text("DeviceVersion", reg::kDeviceVersion, 32);
  d.text("DeviceSerialNumber", reg::kSerial, 16);
  d.text("DeviceUserID", reg::kUserName, reg::kUserNameBytes, "RW");
  d.command("TimestampLatch", reg::kTimestampControl, gvcp::kLatchTimestamp);
  d.wide("TimestampLatchValue", reg::kTimestampHigh);

  d.category("ImageFormatControl", {"SensorWidth", "SensorHeight", "WidthMax", "HeightMax", "Width", "Height",
                                    "OffsetX", "OffsetY", "PixelFormat"});
  d.integer("SensorWidth", feature::kSensorWidth, "RO", "");
  d.integer("SensorHeight", feature::kSensorHeight, "RO", "");
  d.integer("WidthMax", feature::kSensorWidth, "RO", "");
  d.integer("HeightMax", feature::kSensorHeight, "RO", "");
  d.integer("Width", feature::kWidth, "RW",
            "<Min>" + std::to_string(options.width_increment) + "</Min><pMax>SensorWidth</pMax>" + across_increment);
  d.integer("Height", feature::kHeight, "RW", "<Min>1</Min><pMax>SensorHeight</pMax><Inc>1</Inc>");
  d.integer("OffsetX", feature::kOffsetX, "RW", "<Min>0</Min><pMax>OffsetXMax</pMax>" + across_increment);
  d.integer("OffsetY", feature::kOffsetY, "RW", "<Min>0</Min><pMax>OffsetYMax</pMax><Inc>1</Inc>");
  d.difference("OffsetXMax", "SensorWidth", "Width");
  d.difference("OffsetYMax", "SensorHeight", "Height");
  std::vector<Description::Entry> formats;
  for (const SensorFormat format : kAllSensorFormats) {
    const SensorFormatInfo info = sensor_format_info(format);
    formats.push_back({std::string(info.name), info.pfnc});
  }
  d.enumeration("PixelFormat", feature::kPixelFormat, formats);

  d.category("AcquisitionControl",
             {"AcquisitionMode", "AcquisitionStart", "AcquisitionStop", "ExposureTime", "AcquisitionFrameRate",
              "AcquisitionFrameRateEnable", "TriggerSelector", "TriggerMode", "TriggerSource", "TriggerSoftware"});
  d.enumeration("AcquisitionMode", feature::kAcquisitionMode, {{"Continuous", 0}, {"SingleFrame", 1}});
  d.command("AcquisitionStart", feature::kAcquisitionStart);
  d.command("AcquisitionStop", feature::kAcquisitionStop);
  d.number("ExposureTime", feature::kExposureTime, 10.0, 10000000.0, "us");
  d.number("AcquisitionFrameRate", feature::kFrameRate, 0.1, kLargestFrameRate_hz, "Hz");
  d.boolean("AcquisitionFrameRateEnable", feature::kFrameRateEnable);
  d.enumeration("TriggerSelector", feature::kTriggerSelector, {{"FrameStart", 0}});
  d.enumeration("TriggerMode", feature::kTriggerMode, {{"Off", 0}, {"On", 1}});
  d.enumeration("TriggerSource", feature::kTriggerSource, {{"Software", 0}, {"Line0", 1}});
  d.command("TriggerSoftware", feature::kTriggerSoftware);

  d.category("AnalogControl", {"Gain"});
  d.number("Gain", feature::kGain, 0.0, 24.0, "dB");

  if (options.chunk_mode) {
    d.category("ChunkDataControl", {"ChunkModeActive"});
    d.boolean("ChunkModeActive", feature::kChunkModeActive);
  }

  d.category("TransportLayerControl",
             {"PayloadSize", "TLParamsLocked", "GevSCPSPacketSize", "GevSCPD", "GevHeartbeatTimeout",
              "GevTimestampControlLatch", "GevTimestampValue", "GevTimestampTickFrequency"});
  d.integer("PayloadSize", feature::kPayloadSize, "RO", "");
  d.integer("TLParamsLocked", feature::kParametersLocked, "RW", "<Min>0</Min><Max>1</Max>");
  d.half("GevSCPSPacketSize", reg::kStreamPacketSize,
         "<Min>576</Min><Max>16000</Max><Inc>" + std::to_string(kPacketSizeIncrement) + "</Inc>");
  d.integer("GevSCPD", reg::kStreamPacketDelay, "RW",
            "<Min>0</Min><Max>" + std::to_string(kLargestPacketDelay_ns) + "</Max>");
  d.integer("GevHeartbeatTimeout", reg::kHeartbeatTimeout, "RW", "<Min>500</Min><Max>60000</Max>");
  d.command("GevTimestampControlLatch", reg::kTimestampControl, gvcp::kLatchTimestamp);
  d.wide("GevTimestampValue", reg::kTimestampHigh);
  d.wide("GevTimestampTickFrequency", reg::kTickFrequencyHigh);
  return d.finished();
}

}  // namespace fvd::sim
