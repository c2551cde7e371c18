#pragma once
#include <unistd.h>

#include <filesystem>

#include "unit/io/mesh_file_support.h"
#include "uplift/base/file.h"
#include "uplift/io/hdf5/library.h"
#include "uplift/io/mesh/med.h"
#include "uplift/io/mesh/med_file.h"

// Files of MED that tests make by the C library of HDF5.
namespace uplift::sample {

inline const std::string step = "/ENS_MAA/soil/-0000000000000000001-0000000000000000001";

/// An HDF5 file, made by the C library alone.
class RawFile {
 public:
  RawFile()
      : path_(std::filesystem::temp_directory_path() /
              ("uplift-raw-" + std::to_string(::getpid()) + "-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".med")) {
    const Hdf5Call call;
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);  // as MED does
    H5Pset_file_locking(access, false, true);
    file = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    parents = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(parents, 1);
  }
  ~RawFile() {
    H5Pclose(parents);
    H5Fclose(file);
    std::filesystem::remove(path_);
  }
  RawFile(const RawFile&) = delete;
  RawFile& operator=(const RawFile&) = delete;

  void group(const std::string& path) { H5Gclose(H5Gcreate2(file, path.c_str(), parents, H5P_DEFAULT, H5P_DEFAULT)); }
  void attribute(const std::string& path, const char* name, int value) {
    const hid_t space = H5Screate(H5S_SCALAR), object = H5Oopen(file, path.c_str(), H5P_DEFAULT);
    if (H5Aexists(object, name) > 0) H5Adelete(object, name);
    const hid_t made = H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(made, H5T_NATIVE_INT, &value);
    H5Aclose(made);
    H5Oclose(object);
    H5Sclose(space);
  }
  /// `values` null: nothing is written.
  void data(const std::string& path, hid_t file_type, hid_t memory_type, const void* values, std::vector<hsize_t> lengths,
            hid_t storage = H5P_DEFAULT) {
    const hid_t space = H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr);
    const hid_t made = H5Dcreate2(file, path.c_str(), file_type, space, parents, storage, H5P_DEFAULT);
    if (values) H5Dwrite(made, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    H5Dclose(made);
    H5Sclose(space);
  }
  void integers(const std::string& path, const std::vector<int>& values, hid_t type = H5T_STD_I64LE) {
    data(path, type, H5T_NATIVE_INT, values.data(), {values.size()});
  }
  void numbers(const std::string& path, const std::vector<double>& values) {
    data(path, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), {values.size()});
  }
  /// Names of groups as MED 3 and 4 write them: arrays of 80 bytes.
  void names(const std::string& path, const std::vector<std::string>& names) {
    const hsize_t length = 80;
    const hid_t type = H5Tarray_create2(H5T_STD_I8LE, 1, &length);
    std::string all(80 * names.size(), '\0');
    for (std::size_t i = 0; i < names.size(); ++i) all.replace(80 * i, names[i].size(), names[i]);
    data(path, type, type, all.data(), {names.size()});
    H5Tclose(type);
  }
  void remove(const std::string& path) { H5Ldelete(file, path.c_str(), H5P_DEFAULT); }

  std::string image() const {
    H5Fflush(file, H5F_SCOPE_GLOBAL);
    return read_file(path_);
  }

  hid_t file = -1, parents = -1;

 private:
  std::filesystem::path path_;
};

/// Every type of cell; family -1 - s for type s, in the groups "cells of TYPE" and, for volumes, "all volumes"; nodes of odd number,
/// counted from 0, in a group.
class SampleFile : public RawFile {
 public:
  explicit SampleFile(const std::vector<Shape>& all = shapes()) {
    group("/INFOS_GENERALES");
    attribute("/INFOS_GENERALES", "MAJ", 4);
    group(step);
    attribute("/ENS_MAA/soil", "ESP", 3);
    attribute("/ENS_MAA/soil", "TYP", 0);
    int first = 1;
    for (std::size_t s = 0; s < all.size(); ++s) {
      const std::vector<Vec3> own = med_nodes(all[s], s);
      std::vector<int> nodes;
      for (std::size_t n = 0; n < own.size(); ++n) nodes.push_back(first + static_cast<int>(n));
      first += static_cast<int>(own.size());
      points.insert(points.end(), own.begin(), own.end());
      const std::string type = step + "/MAI/" + all[s].med, family = "/FAS/soil/ELEME/FAM_" + std::to_string(s);
      integers(type + "/NOD", nodes);
      attribute(type + "/NOD", "NBR", 1);
      integers(type + "/FAM", {-1 - static_cast<int>(s)}, H5T_STD_I32LE);
      group(family);
      attribute(family, "NUM", -1 - static_cast<int>(s));
      names(family + "/GRO/NOM", info(all[s].cell).dimension == 3
                                     ? std::vector<std::string>{"cells of " + std::string(all[s].med), "all volumes"}
                                     : std::vector<std::string>{"cells of " + std::string(all[s].med)});
    }
    std::vector<double> x;
    std::vector<int> families;
    for (int k = 0; k < 3; ++k)
      for (const Vec3& point : points) x.push_back(point[k]);
    for (std::size_t i = 0; i < points.size(); ++i) families.push_back(i % 2 ? 1 : 0);
    numbers(step + "/NOE/COO", x);
    integers(step + "/NOE/FAM", families);
    group("/FAS/soil/NOEUD/FAM_1");
    attribute("/FAS/soil/NOEUD/FAM_1", "NUM", 1);
    names("/FAS/soil/NOEUD/FAM_1/GRO/NOM", {"odd nodes"});
    group("/FAS/soil/FAMILLE_ZERO");
    attribute("/FAS/soil/FAMILLE_ZERO", "NUM", 0);
  }
  std::vector<Vec3> points;
};

inline Mesh read_image(const RawFile& file, const std::string& mesh = {}) {
  return read_med(Hdf5Reader::from_memory(file.image(), "a.med"), mesh);
}

}  // namespace uplift::sample
