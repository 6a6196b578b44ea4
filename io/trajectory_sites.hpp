#pragma once
/// The sites of rigid bodies in frames of run.h5: particles of a group of their own, which readers of H5MD show as
/// atoms.
///
/// | path | what | shape |
/// |---|---|---|
/// | /particles/sites/position, velocity | `value`; `step` and `time` are those of /particles/system | (frames, m, 3) |
/// | /particles/sites/image | `value`, where the box is periodic | (frames, m, 3) |
/// | /particles/sites/box | that of /particles/system | |
/// | /particles/sites/id, mass | ids count from 0; masses may be 0 | (m) |
/// | /particles/sites/name | of the site; of a body of one site, of one without a name, and of a point the particle's |
/// (m) | | /particles/sites/particle | the id of the particle that it is a site of | (m) | | /particles/sites/species,
/// charge | where particles have types, and where there are charges | (m) |
///
/// Particles stand in the order of their ids, sites of a body in the order of its kind; a point is a site of its own.

#include "engine/sites.hpp"
#include "io/buffered_dataset.hpp"
#include "io/frames.hpp"
#include "io/hdf5_file.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace noether::io {

/// What sites have once, in the order of the rows of their frames.
struct SiteConstants {
  std::vector<std::int64_t> particles;  ///< indices of the particles that they are sites of
  std::vector<std::string> names;
  std::vector<double> masses;       ///< [mass]; 0 where a site has none
  std::vector<double> charges;      ///< [charge]; empty where there are none
  std::vector<std::int64_t> types;  ///< from 0; empty where particles have none
};

/// @param sites  those of `bodies`
/// @param order  indices of the particles in the order of the rows
SiteConstants site_constants(const ParticleSystem<double>& bodies, const Sites<double>& sites,
                             const std::vector<Index>& order);

/// Where sites are and how they move, v + Omega x arm.
/// @param sites  those of `bodies`, placed where these are
/// @param rows  overwritten
void site_rows(const ParticleSystem<double>& bodies, const Sites<double>& sites, const std::vector<Index>& order,
               SiteRows& rows);

/// Whether some body has several sites, so that they show more than its centre does.
bool has_several_sites(const ParticleSystem<double>& s);

/// The datasets of sites, open, while frames are written; none where the file has none.
class SiteDatasets {
 public:
  /// Makes the group, and its datasets without a row.
  /// @param rows_at_once  rows to a piece on disk, by how many numbers a row has
  /// @throws Error  where no body has several sites; FileError
  void create(const Hdf5File& file, const ParticleSystem<double>& state, const std::vector<Index>& order,
              const std::function<Index(Index)>& rows_at_once);
  /// Goes on with those of a file, if it has any.
  /// @param open  a dataset of rows of such a shape. @throws FileError  if they are not
  void open(const Hdf5File& file,
            const std::function<Hdf5Dataset(const std::string& path, const std::vector<Index>& row)>& open);
  /// Adds a row to each. @throws FileError  where bodies have got other sites since
  void append(const ParticleSystem<double>& state, const std::vector<Index>& order, SiteRows& rows);
  void write_out();

 private:
  BufferedDataset<double> position_, velocity_;
  BufferedDataset<std::int64_t> image_;
  KeptSites<double> sites_;
  Index count_ = 0;
};

/// The datasets of sites that grow; none where the file has none.
std::vector<std::string> growing_sites(const Hdf5File& file);

}  // namespace noether::io
