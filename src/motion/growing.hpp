// Tables that grow without being copied: a run shares its rows with the run that it continues.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace dinal::motion {

/// Rows of one or more values; each column is contiguous. Written rows never change. A table that extends another one
/// uses the same memory behind its rows if there is room and no other table has claimed it: n successive extensions
/// cost as much as the last table, and each keeps its own length.
///
/// The last row of an extension is kept apart until its columns are needed: often it exists only because the run ended
/// there, and the next extension overwrites it.
template <class T>
class Growing {
public:
    Growing() = default;
    /// Rows to be filled through `writable_values`.
    Growing(std::size_t rows, std::size_t columns) : store_(Store::with_room(rows, columns)), size_(rows) {
        store_->used = rows;
    }
    /// A single column.
    explicit Growing(std::vector<T> values) {
        if (values.empty()) return;
        size_ = values.size();
        store_ = std::make_shared<Store>(Store{nullptr, values.data(), size_, 1, size_, std::move(values)});
    }
    /// Views columns at `values`, which `owner` keeps alive.
    Growing(std::size_t rows, T* values, std::size_t columns, std::shared_ptr<void> owner)
        : store_(std::make_shared<Store>(Store{std::move(owner), values, rows, columns, rows})), size_(rows) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::size_t columns() const { return store_ == nullptr ? 0 : store_->columns; }

    [[nodiscard]] const T& operator()(std::size_t row, std::size_t column) const {
        return row < placed() ? store_->column(column)[row] : last_[column];
    }
    std::span<const T> column(std::size_t column) const {
        if (size_ == 0) return {};
        place_last();
        return {store_->column(column), size_};
    }
    /// The distance between the beginnings of two columns.
    std::size_t stride() const {
        place_last();
        return store_ == nullptr ? 0 : store_->room;
    }

    // Access to the first column, as to a list:
    const T& operator[](std::size_t row) const { return (*this)(row, 0); }
    const T& front() const { return (*this)(0, 0); }
    const T& back() const { return (*this)(size_ - 1, 0); }
    auto begin() const { return column(0).begin(); }
    auto end() const { return column(0).end(); }

    /// Pointer to the values of a new table. Must not be used on shared rows.
    [[nodiscard]] T* writable_values() { return store_ == nullptr ? nullptr : store_->values; }

    /// The first `kept` rows followed by those of `later`. New memory reserves room for at most as many rows again, up
    /// to `most` in total.
    Growing followed_by(std::size_t kept, const Growing& later, std::size_t most) const {
        assert(kept <= size_);
        if (later.empty() && kept == size_) return *this;
        Growing both;
        both.size_ = kept + later.size();
        both.store_ = store_for(kept, both.size_, std::max(columns(), later.columns()), most);
        Store& store = *both.store_;
        for (std::size_t column = 0; column < store.columns; ++column) {
            copy(column, store.used, kept, store.column(column) + store.used);
            if (later.empty()) continue;
            later.copy(column, 0, later.size() - 1, store.column(column) + kept);
            both.last_.push_back(later(later.size() - 1, column));
        }
        store.used = both.placed();
        return both;
    }

    /// A copy of the first rows in memory of its own.
    Growing first(std::size_t rows) const {
        assert(rows <= size_);
        Growing part(rows, columns());
        for (std::size_t column = 0; column < columns(); ++column) copy(column, 0, rows, part.store_->column(column));
        return part;
    }

    /// The bytes of this table; 0 if other tables share them.
    std::size_t own_bytes() const { return store_.use_count() == 1 ? store_->room * store_->columns * sizeof(T) : 0; }

private:
    struct Store {
        std::shared_ptr<void> owner;
        T* values;
        std::size_t room, columns;
        std::size_t used;       ///< rows claimed by any table
        std::vector<T> list{};  // owns `values` if they were given as a vector

        T* column(std::size_t i) const { return values + i * room; }
        static std::shared_ptr<Store> with_room(std::size_t rows, std::size_t columns) {
            if (rows == 0) return std::make_shared<Store>(Store{nullptr, nullptr, 0, columns, 0});
            auto own = std::make_shared_for_overwrite<T[]>(rows * columns);
            T* values = own.get();
            return std::make_shared<Store>(Store{std::move(own), values, rows, columns, 0});
        }
    };

    std::size_t placed() const { return size_ - (last_.empty() ? 0 : 1); }

    void copy(std::size_t column, std::size_t from, std::size_t until, T* to) const {
        const std::size_t stored = std::min(until, placed());
        if (from < stored) to = std::copy(store_->column(column) + from, store_->column(column) + stored, to);
        if (std::max(from, stored) < until) *to = last_[column];
    }

    /// The memory for rows after the first `kept`: the present one if it has room behind them, otherwise a new one.
    std::shared_ptr<Store> store_for(std::size_t kept, std::size_t rows, std::size_t columns, std::size_t most) const {
        const bool free = store_ != nullptr && store_->used == std::min(kept, placed()) && rows <= store_->room;
        if (free) return store_;
        return Store::with_room(std::max(rows, std::min(rows + kept, most)), columns);
    }

    void place_last() const {
        if (last_.empty()) return;
        if (store_->used != placed()) {
            auto own = Store::with_room(size_, store_->columns);
            for (std::size_t i = 0; i < own->columns; ++i) copy(i, 0, placed(), own->column(i));
            store_ = std::move(own);
        }
        for (std::size_t i = 0; i < store_->columns; ++i) store_->column(i)[size_ - 1] = last_[i];
        store_->used = size_;
        last_.clear();
    }

    mutable std::shared_ptr<Store> store_;  // shared with the tables it extends and those that extend it
    std::size_t size_ = 0;
    mutable std::vector<T> last_;  // the row that is kept apart
};

}  // namespace dinal::motion
