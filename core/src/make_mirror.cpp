#include <symsurf/errors.h>
#include <symsurf/make_mirror.h>
#include <symsurf/plane.h>
#include <symsurf/sphere.h>

#include <array>
#include <string>

namespace symsurf {

namespace {

template <typename T>
const T& number(const Values& numbers, const std::string& name) {
  const auto it = numbers.find(name);
  const T* value = it == numbers.end() ? nullptr : std::get_if<T>(&it->second);
  if (!value)
    throw InvalidInput("the mirror's " + name + " is " +
                       (it == numbers.end() ? "missing" : "'" + to_string(it->second) + "'"));
  return *value;
}

struct Kind {
  std::string_view name;
  std::shared_ptr<Mirror> (*make)(const Values&);
};

constexpr std::array kinds{
    Kind{"plane",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<Plane>(number<Vector3>(v, "normal"),
                                          number<double>(v, "offset"));
         }},
    Kind{"sphere",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<Sphere>(number<Vector3>(v, "centre"),
                                           number<double>(v, "radius"));
         }},
};

}  // namespace

std::shared_ptr<Mirror> make_mirror(std::string_view kind, const Values& numbers) {
  std::string names;
  for (const Kind& known : kinds) {
    if (known.name == kind) return known.make(numbers);
    names += (names.empty() ? "" : ", ") + std::string(known.name);
  }
  throw InvalidInput("there is no mirror of the kind '" + std::string(kind) + "'; there are " +
                     names);
}

}  // namespace symsurf
