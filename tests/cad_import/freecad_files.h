// FreeCAD documents that the tests write for themselves: ZIP archives of XML and BREP text.
#pragma once

#include <zip.h>

#include <BRepTools.hxx>
#include <BinTools.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace catoptra::test {

using ZipEntries = std::vector<std::pair<std::string, std::string>>;

inline std::filesystem::path write_zip(const std::filesystem::path& file, const ZipEntries& entries,
                                       bool packed = true) {
  int code = 0;
  zip_t* archive = zip_open(file.string().c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (!archive) throw std::runtime_error("the test could not write " + file.string());
  for (const auto& [name, bytes] : entries) {
    const zip_int64_t at = zip_file_add(
        archive, name.c_str(), zip_source_buffer(archive, bytes.data(), bytes.size(), 0), ZIP_FL_ENC_UTF_8);
    zip_set_file_compression(archive, static_cast<zip_uint64_t>(at), packed ? ZIP_CM_DEFLATE : ZIP_CM_STORE,
                             0);
  }
  if (zip_close(archive) != 0) throw std::runtime_error("the test could not write " + file.string());
  return file;
}

inline std::string brep_text(const TopoDS_Shape& shape) {
  std::ostringstream out;
  BRepTools::Write(shape, out);
  return out.str();
}

inline std::string brep_binary(const TopoDS_Shape& shape) {
  std::ostringstream out;
  BinTools::Write(shape, out);
  return out.str();
}

// Properties as FreeCAD 1.0 writes them.
inline std::string property(const std::string& name, const std::string& type, const std::string& value) {
  return "<Property name=\"" + name + "\" type=\"" + type + "\">" + value + "</Property>\n";
}
inline std::string shape_property(const std::string& entry) {
  return property("Shape", "Part::PropertyPartShape",
                  "<Part ElementMap=\"\" file=\"" + entry + "\"/><ElementMap/>");
}
/// A shift, mm, after a turn by the quaternion (x, y, z; w).
inline std::string placement(double x, double y, double z, const std::string& name = "Placement",
                             double qx = 0, double qy = 0, double qz = 0, double qw = 1) {
  std::ostringstream v;
  v.precision(17);
  v << "<PropertyPlacement Px=\"" << x << "\" Py=\"" << y << "\" Pz=\"" << z << "\" Q0=\"" << qx << "\" Q1=\""
    << qy << "\" Q2=\"" << qz << "\" Q3=\"" << qw << "\"/>";
  return property(name, "App::PropertyPlacement", v.str());
}
inline std::string link_list(const std::string& name, const std::vector<std::string>& objects) {
  std::string value = "<LinkList count=\"" + std::to_string(objects.size()) + "\">";
  for (const std::string& object : objects) value += "<Link value=\"" + object + "\"/>";
  return property(name, "App::PropertyLinkList", value + "</LinkList>");
}
inline std::string link(const std::string& name, const std::string& object) {
  return property(name, "App::PropertyLink", "<Link value=\"" + object + "\"/>");
}
inline std::string x_link(const std::string& object, const std::string& file = "",
                          const std::string& sub = "") {
  return property("LinkedObject", "App::PropertyXLink",
                  "<XLink file=\"" + file + "\" stamp=\"\" name=\"" + object + "\"" +
                      (sub.empty() ? "/>" : " sub=\"" + sub + "\"></XLink>"));
}
inline std::string boolean(const std::string& name, bool value) {
  return property(name, "App::PropertyBool",
                  std::string("<Bool value=\"") + (value ? "true" : "false") + "\"/>");
}

/// Collects objects and entries.
class FreecadFile {
 public:
  /// `properties`: what property() and the like made, one after the other. `view`: the same for its
  /// appearance.
  void object(const std::string& type, const std::string& name, const std::string& label,
              const std::string& properties, bool visible = true, const std::string& view = "") {
    objects_ += "<Object type=\"" + type + "\" name=\"" + name + "\"/>\n";
    data_ += "<Object name=\"" + name + "\"><Properties>\n" +
             property("Label", "App::PropertyString", "<String value=\"" + label + "\"/>") + properties +
             "</Properties></Object>\n";
    views_ += "<ViewProvider name=\"" + name + "\"><Properties>\n" + boolean("Visibility", visible) + view +
              "</Properties></ViewProvider>\n";
  }
  /// An object with the shape `shape`, whose location is its placement.
  void shape(const std::string& type, const std::string& name, const std::string& label,
             const TopoDS_Shape& shape, const std::string& properties = "", bool visible = true,
             const std::string& view = "") {
    object(type, name, label, properties + shape_property(name + ".Shape.brp"), visible, view);
    entries.emplace_back(name + ".Shape.brp", brep_text(shape));
  }

  [[nodiscard]] std::string document_xml() const {
    return "<?xml version='1.0' encoding='utf-8'?>\n<Document SchemaVersion=\"4\" ProgramVersion=\"1.0\" "
           "FileVersion=\"1\">\n<Objects>" +
           objects_ + "</Objects>\n<ObjectData>" + data_ + "</ObjectData>\n</Document>\n";
  }
  [[nodiscard]] std::string gui_xml() const {
    return "<?xml version='1.0' encoding='utf-8'?>\n<Document SchemaVersion=\"1\">\n<ViewProviderData>" +
           views_ + "</ViewProviderData>\n</Document>\n";
  }
  std::filesystem::path write(const std::filesystem::path& file, bool with_gui = true,
                              bool packed = true) const {
    ZipEntries all{{"Document.xml", document_xml()}};
    if (with_gui) all.emplace_back("GuiDocument.xml", gui_xml());
    all.insert(all.end(), entries.begin(), entries.end());
    return write_zip(file, all, packed);
  }

  ZipEntries entries;  ///< beside the two of XML

 private:
  std::string objects_, data_, views_;
};

}  // namespace catoptra::test
