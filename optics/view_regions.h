// Which part of what an optic's vertices meet its one virtual viewpoint can show: reversed region, zooming
// region, the piece between them, and what lies behind one of two line foci (paper 4.2, Fig. 8; design 2.10).
#pragma once

#include <cstddef>
#include <span>

#include "optics/vertex_hits.h"
#include "optics/virtual_view.h"

namespace catoptra::optics {

inline constexpr double kCloseCrossing = 0.1;

/// Numbers of vertices that show something. Those of several patches can be added.
struct ViewRegions {
  std::size_t vertices = 0;
  std::size_t zooming = 0;  ///< what they meet lies in the zooming region
  /// It stands so close to where the rays cross that it lies in neither region, or that the ray passes the
  /// viewpoint by more than kCloseCrossing of half the map's width there: what hides what is lost.
  std::size_t close = 0;
  /// Neighbouring rays have crossed in one direction, and not in the other, before what they meet: it lies
  /// between the two line foci of an astigmatic bundle (saddles, cylinders, oblique mirrors). A vertex shows
  /// it all the same, yet no single viewpoint knows what hides what there.
  std::size_t crossed_once = 0;

  ViewRegions& operator+=(const ViewRegions& other);
};

/// Counts over the vertices of a mirror or of a lens at one wavelength. By ray differentials: Igehy 1999.
[[nodiscard]] ViewRegions view_regions(std::span<const VertexHit> hits, const VirtualView& view);

}  // namespace catoptra::optics
