#include "motion/course.hpp"

#include <algorithm>
#include <limits>

#include "motion/growing.hpp"

namespace dinal::motion {

namespace {

struct Part {
    double from = 0;
    std::shared_ptr<const Course> course;
};

class JoinedCourse final : public Course {
public:
    explicit JoinedCourse(const std::shared_ptr<const Course>& first)
        : Course(first->system()),
          parts_(std::vector<Part>{{-model::never, first}}),
          whole_until_(first->whole_until()),
          bytes_(first->bytes()) {}
    JoinedCourse(const JoinedCourse& before, const Part& last)
        : Course(before.system()),
          parts_(before.parts_.followed_by(before.parts_.size(), Growing<Part>(std::vector<Part>{last}),
                                           std::numeric_limits<std::size_t>::max())),
          whole_until_(before.whole_until_ < last.from ? before.whole_until_
                                                       : std::max(last.from, last.course->whole_until())),
          bytes_(before.bytes_ + last.course->bytes()) {}

    text::Expected<model::State> at(double t) const override { return course_at(t).at(t); }
    std::vector<double> states_at(double t) const override { return course_at(t).states_at(t); }
    double whole_until() const override { return whole_until_; }
    std::vector<double> piece_ends() const override {
        std::vector<double> all;
        for (const Part& part : parts_) {
            const std::vector<double> own = part.course->piece_ends();
            all.insert(all.end(), own.begin(), own.end());
        }
        return all;
    }
    void legs(const std::function<void(const Leg&)>& visit) const override {
        for (const Part& part : parts_) part.course->legs(visit);
    }
    std::size_t bytes() const override { return bytes_; }

private:
    const Course& course_at(double t) const {
        const auto after = std::upper_bound(parts_.begin() + 1, parts_.end(), t,
                                            [](double time, const Part& part) { return time < part.from; });
        return *(after - 1)->course;
    }

    Growing<Part> parts_;
    double whole_until_;
    std::size_t bytes_;
};

}  // namespace

std::shared_ptr<const Course> joined(const std::shared_ptr<const Course>& before, double from,
                                     std::shared_ptr<const Course> after) {
    if (before == nullptr || after == nullptr) return nullptr;
    Part last{from, std::move(after)};
    if (const auto* parts = dynamic_cast<const JoinedCourse*>(before.get())) {
        return std::make_shared<JoinedCourse>(*parts, std::move(last));
    }
    return std::make_shared<JoinedCourse>(JoinedCourse(before), std::move(last));
}

}  // namespace dinal::motion
