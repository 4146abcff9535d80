// The search of a packet, included in a class for each set of instructions. Nothing of Eigen or of
// the standard library is called, so that no other code is compiled for the wider ones.

static constexpr int wide = SYMSURF_WIDE;  // lanes at a time
typedef float Floats __attribute__((vector_size(4 * wide)));
typedef std::int32_t Integers __attribute__((vector_size(4 * wide)));

// A bit for each lane.
static inline unsigned mask_of(const Integers& holds) {
#if SYMSURF_WIDE == 8
  return static_cast<unsigned>(__builtin_ia32_movmskps256((Floats)holds));
#elif defined(__SSE2__)
  return static_cast<unsigned>(__builtin_ia32_movmskps((Floats)holds));
#else
  unsigned mask = 0;
  for (int i = 0; i < wide; ++i) mask |= (holds[i] & 1u) << i;
  return mask;
#endif
}

// By references: how vectors are passed depends on the instructions.
static inline void outside(float low, float high, const Floats& q, Floats& off) {
  const Floats below = low - q, above = q - high, most = below > above ? below : above;
  off = most > 0 ? most : Floats{};
}

struct Queries {
  Floats x, y, z;
  float error;

  void squared_distance(const Node& box, Floats& squared) const {
    Floats u, v, w;
    outside(box.low[0] - error, box.high[0] + error, x, u);
    outside(box.low[1] - error, box.high[1] + error, y, v);
    outside(box.low[2] - error, box.high[2] + error, z, w);
    squared = u * u + v * v + w * w;
  }
};

// Of the lanes from one on.
static void search(Packet& packet, int lane) {
  const Queries queries{*reinterpret_cast<const Floats*>(packet.x + lane),
                        *reinterpret_cast<const Floats*>(packet.y + lane),
                        *reinterpret_cast<const Floats*>(packet.z + lane), packet.error};
  constexpr float more = 1.00001f;  // of boxes: their distance is a bound
  Floats reach = *reinterpret_cast<const Floats*>(packet.reach + lane), within = more * reach,
         runner_up = 1e38f - Floats{}, one, other;
  Integers nearest = -1 - Integers{};
  std::uint32_t waiting[deepest];
  int count = 0;
  for (std::uint32_t at = 0;;) {
    const Node& node = packet.nodes[at];
    if (node.begin == none) {
      const std::uint32_t first = at + 1, second = node.end;
      queries.squared_distance(packet.nodes[first], one);
      queries.squared_distance(packet.nodes[second], other);
      const bool enters_first = mask_of(one <= within) != 0,
                 enters_second = mask_of(other <= within) != 0;
      if (enters_first && enters_second) {
        // Where most of the queries are nearer.
        const bool swaps =
            __builtin_popcount(mask_of(other < one)) > __builtin_popcount(mask_of(one < other));
        waiting[count++] = swaps ? first : second;
        at = swaps ? second : first;
        continue;
      }
      if (enters_first || enters_second) {
        at = enters_first ? first : second;
        continue;
      }
    } else {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const float* point = packet.points + 3 * static_cast<std::size_t>(i);
        const Floats u = point[0] - queries.x, v = point[1] - queries.y, w = point[2] - queries.z;
        const Floats squared = u * u + v * v + w * w;
        const Integers is_nearer = squared <= reach;
        const Floats further = reach > squared ? reach : squared;
        runner_up = runner_up < further ? runner_up : further;
        reach = reach < squared ? reach : squared;
        nearest = is_nearer ? static_cast<std::int32_t>(i) - Integers{} : nearest;
      }
      within = more * reach;
    }
    bool has_next = false;
    while (count > 0 && !has_next) {
      at = waiting[--count];
      queries.squared_distance(packet.nodes[at], one);
      has_next = mask_of(one <= within) != 0;
    }
    if (!has_next) break;
  }
  *reinterpret_cast<Floats*>(packet.runner_up + lane) = runner_up;
  *reinterpret_cast<Integers*>(packet.nearest + lane) = nearest;
}

static void search_all(Packet& packet) {
  for (int lane = 0; lane < lanes; lane += wide) search(packet, lane);
}
