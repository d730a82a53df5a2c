//! The six degrees of freedom and five fingers, in register order. Contains no values.

use serde::{Deserialize, Serialize};

/// One of the six driven degrees of freedom, in the manual's register order (§2.6).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dof {
    /// 小拇指, index 0.
    Little,
    /// 无名指, index 1.
    Ring,
    /// 中指, index 2.
    Middle,
    /// 食指, index 3.
    Index,
    /// 大拇指弯曲, index 4.
    ThumbBend,
    /// 大拇指旋转, index 5.
    ThumbRotate,
}

impl Dof {
    /// All six, in register order.
    pub const ALL: [Self; 6] = [
        Self::Little,
        Self::Ring,
        Self::Middle,
        Self::Index,
        Self::ThumbBend,
        Self::ThumbRotate,
    ];

    /// Position in a register group, 0..=5.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Stable lower-case name for files and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Little => "little",
            Self::Ring => "ring",
            Self::Middle => "middle",
            Self::Index => "index",
            Self::ThumbBend => "thumb_bend",
            Self::ThumbRotate => "thumb_rotate",
        }
    }

    /// Range of the joint in degrees `(at 0, at 1000)`.
    ///
    /// Manual: §2.6.11 prints only the little finger (20..176). The other figures come from
    /// the sister manual of the same family; the mapping is assumed to be linear.
    pub const fn degrees(self) -> (f32, f32) {
        match self {
            Self::Little | Self::Ring | Self::Middle | Self::Index => (20.0, 176.0),
            Self::ThumbBend => (-13.0, 70.0),
            Self::ThumbRotate => (90.0, 165.0),
        }
    }

    /// Finger that this joint moves.
    pub const fn finger(self) -> Finger {
        match self {
            Self::Little => Finger::Little,
            Self::Ring => Finger::Ring,
            Self::Middle => Finger::Middle,
            Self::Index => Finger::Index,
            Self::ThumbBend | Self::ThumbRotate => Finger::Thumb,
        }
    }
}

/// One of the five fingers with a tactile sensor, in the manual's register order (§2.6).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finger {
    /// 小拇指.
    Little,
    /// 无名指.
    Ring,
    /// 中指.
    Middle,
    /// 食指.
    Index,
    /// 大拇指.
    Thumb,
}

impl Finger {
    /// All five, in register order.
    pub const ALL: [Self; 5] = [
        Self::Little,
        Self::Ring,
        Self::Middle,
        Self::Index,
        Self::Thumb,
    ];

    /// Position in the tactile map, 0..=4.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Stable lower-case name for files and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Little => "little",
            Self::Ring => "ring",
            Self::Middle => "middle",
            Self::Index => "index",
            Self::Thumb => "thumb",
        }
    }

    /// The joint that bends this finger.
    pub const fn bend(self) -> Dof {
        match self {
            Self::Little => Dof::Little,
            Self::Ring => Dof::Ring,
            Self::Middle => Dof::Middle,
            Self::Index => Dof::Index,
            Self::Thumb => Dof::ThumbBend,
        }
    }
}

macro_rules! per {
    ($(#[$doc:meta])* $name:ident, $key:ident, $n:literal) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize)]
        pub struct $name<T>([T; $n]);

        impl<T> $name<T> {
            /// Creates it from values in register order.
            pub const fn new(values: [T; $n]) -> Self {
                Self(values)
            }

            /// Calls `make` for each key.
            pub fn from_fn(mut make: impl FnMut($key) -> T) -> Self {
                Self($key::ALL.map(|key| make(key)))
            }

            /// Returns the values in register order.
            pub const fn as_array(&self) -> &[T; $n] {
                &self.0
            }

            /// Iterates over keys and values in register order.
            pub fn iter(&self) -> impl Iterator<Item = ($key, &T)> {
                $key::ALL.into_iter().zip(self.0.iter())
            }

            /// Iterates over keys and mutable values in register order.
            pub fn iter_mut(&mut self) -> impl Iterator<Item = ($key, &mut T)> {
                $key::ALL.into_iter().zip(self.0.iter_mut())
            }

            /// Applies a function to each value.
            pub fn map<U>(self, make: impl FnMut(T) -> U) -> $name<U> {
                $name(self.0.map(make))
            }
        }

        impl<T: Copy> $name<T> {
            /// Creates it with the same value for every key.
            pub const fn splat(value: T) -> Self {
                Self([value; $n])
            }
        }

        impl<T> $name<Option<T>> {
            /// Returns all values; `None` if any is missing.
            pub fn all(self) -> Option<$name<T>> {
                let full: arrayvec::ArrayVec<T, $n> = self.0.into_iter().flatten().collect();
                full.into_inner().ok().map($name)
            }
        }

        #[expect(clippy::indexing_slicing, reason = "the key has as many variants as there are values")]
        impl<T> std::ops::Index<$key> for $name<T> {
            type Output = T;
            fn index(&self, key: $key) -> &T {
                &self.0[key.index()]
            }
        }

        #[expect(clippy::indexing_slicing, reason = "the key has as many variants as there are values")]
        impl<T> std::ops::IndexMut<$key> for $name<T> {
            fn index_mut(&mut self, key: $key) -> &mut T {
                &mut self.0[key.index()]
            }
        }
    };
}

per!(
    /// A value for each of the six degrees of freedom.
    PerDof,
    Dof,
    6
);
per!(
    /// A value for each of the five fingers.
    PerFinger,
    Finger,
    5
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn index_follows_register_order() {
        for (i, dof) in Dof::ALL.into_iter().enumerate() {
            assert_eq!(dof.index(), i);
        }
        for (i, finger) in Finger::ALL.into_iter().enumerate() {
            assert_eq!(finger.index(), i);
            assert_eq!(finger.bend().finger(), finger);
        }
    }

    #[test]
    fn all_is_none_when_one_value_is_missing() {
        let mut values = PerDof::new([1, 2, 3, 4, 5, 6]).map(Some);
        assert_eq!(values.all(), Some(PerDof::new([1, 2, 3, 4, 5, 6])));
        values[Dof::Index] = None;
        assert_eq!(values.all(), None);
    }
}
