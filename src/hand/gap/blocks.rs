//! Correction of the model's gap from two blocks of known size: size = scale x gap + offset.

use crate::hand::gap::path::PinchGap;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Smallest difference between two blocks, in mm: closer together, they would not determine the scale. A block closer to a known one
/// than this replaces it.
const APART_MM: f32 = 10.0;
/// Limits of scale and offset (mm). Values beyond them are a mistake: the size was entered wrongly or another object was held.
const SCALES: RangeInclusive<f32> = 0.6..=1.6;
const OFFSET_MM: f32 = 30.0;

/// A measured block: its true size and the gap according to the model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// True size, mm.
    pub size_mm: f32,
    /// Distance of the pads according to the model while the block was held, mm.
    pub gap_mm: f32,
}

impl Block {
    /// Range of allowed sizes, mm.
    pub const SIZES_MM: RangeInclusive<f32> = 1.0..=120.0;
}

/// Size of the held object, mm, and the shape to which it applies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeldSize {
    /// Size of an object like the two blocks measured with this hand.
    Block(f32),
    /// Diameter of a ball, according to the model.
    Ball(f32),
    /// Distance of the pads according to the model; their edges may be in contact, so no shape is known.
    Pads(f32),
}

impl HeldSize {
    /// The size in mm, however it is known.
    pub const fn mm(self) -> f32 {
        match self {
            Self::Block(mm) | Self::Ball(mm) | Self::Pads(mm) => mm,
        }
    }
}

/// The blocks measured with one hand, at most two, the smaller first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "Vec<Block>")]
pub struct SizeBlocks(Vec<Block>);

/// Reason for rejecting a block.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum BlockError {
    /// The size is out of range.
    #[error(
        "a block has {} to {} mm, not {size_mm}",
        Block::SIZES_MM.start(),
        Block::SIZES_MM.end()
    )]
    Size {
        /// Size that was entered, mm.
        size_mm: f32,
    },
    /// Together with the other block it gives an impossible correction.
    #[error(
        "the two blocks do not match the readings of the hand (scale {scale:.2}, offset {offset_mm:.0} mm): measure both again, between thumb and index only"
    )]
    Unlikely {
        /// Resulting scale.
        scale: f32,
        /// Resulting offset, mm.
        offset_mm: f32,
    },
}

/// Correction of a gap, from two blocks.
#[derive(Debug, Clone, Copy)]
struct Correction {
    scale: f32,
    offset_mm: f32,
}

impl Correction {
    fn of(one: Block, two: Block) -> Result<Self, BlockError> {
        let scale = (two.size_mm - one.size_mm) / (two.gap_mm - one.gap_mm);
        let offset_mm = one.size_mm - scale * one.gap_mm;
        if SCALES.contains(&scale) && offset_mm.abs() <= OFFSET_MM {
            Ok(Self { scale, offset_mm })
        } else {
            Err(BlockError::Unlikely { scale, offset_mm })
        }
    }
}

impl SizeBlocks {
    /// Measured blocks.
    pub fn blocks(&self) -> &[Block] {
        &self.0
    }

    /// True if no block was measured.
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds a block. It replaces one of nearly its size or, if there are two, the one closer to it in size.
    ///
    /// # Errors
    /// [`BlockError`]; the blocks are then unchanged.
    pub fn measure(&mut self, block: Block) -> Result<(), BlockError> {
        let size_mm = block.size_mm;
        if !Block::SIZES_MM.contains(&size_mm) {
            return Err(BlockError::Size { size_mm });
        }
        let away = |own: &Block| (own.size_mm - size_mm).abs();
        let mut others = self.0.clone();
        others.sort_by(|one, two| away(one).total_cmp(&away(two)));
        let is_replaced =
            others.len() == 2 || others.first().is_some_and(|own| away(own) < APART_MM);
        let other = others.get(usize::from(is_replaced)).copied();
        // If the other block is as close, too, only the new one stays.
        let other = other.filter(|own| away(own) >= APART_MM);
        let mut blocks: Vec<Block> = other.into_iter().chain([block]).collect();
        blocks.sort_by(|one, two| one.size_mm.total_cmp(&two.size_mm));
        if let [one, two] = blocks.as_slice() {
            Correction::of(*one, *two)?;
        }
        self.0 = blocks;
        Ok(())
    }

    /// Size at a gap of the model, mm, never negative; `None` until two blocks were measured.
    pub fn corrected(&self, gap_mm: f32) -> Option<f32> {
        let [one, two] = self.0.as_slice() else {
            return None;
        };
        let own = Correction::of(*one, *two).ok()?;
        Some((own.scale * gap_mm + own.offset_mm).max(0.0))
    }

    /// Size of the object held at this gap, never negative; from the model alone until two blocks were measured.
    pub fn size(&self, gap: PinchGap) -> HeldSize {
        match (self.corrected(gap.mm), gap.ball_mm) {
            (Some(mm), _) => HeldSize::Block(mm),
            (None, Some(mm)) => HeldSize::Ball(mm),
            (None, None) => HeldSize::Pads(gap.mm),
        }
    }
}

impl From<Vec<Block>> for SizeBlocks {
    fn from(kept: Vec<Block>) -> Self {
        let mut all = Self::default();
        for block in kept {
            // A block that fails the check is dropped; no hand can have measured it.
            let _dropped = all.measure(block);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(size_mm: f32, gap_mm: f32) -> Block {
        Block { size_mm, gap_mm }
    }

    fn pads(mm: f32, ball_mm: Option<f32>) -> PinchGap {
        PinchGap { mm, ball_mm }
    }

    fn measured(blocks: &[Block]) -> SizeBlocks {
        let mut all = SizeBlocks::default();
        for block in blocks {
            all.measure(*block).unwrap();
        }
        all
    }

    #[test]
    fn two_blocks_make_the_sizes_between_and_beyond_them_true() {
        let own = measured(&[block(10.0, 24.0), block(50.0, 64.0)]);
        for (gap, size) in [
            (24.0, 10.0),
            (44.0, 30.0),
            (64.0, 50.0),
            (84.0, 70.0),
            (3.0, 0.0),
        ] {
            let got = own.size(pads(gap, None));
            assert!(
                matches!(got, HeldSize::Block(mm) if (mm - size).abs() < 0.01),
                "{got:?}"
            );
        }
        for few in [&[][..], &[block(10.0, 24.0)]] {
            let own = measured(few);
            assert_eq!(own.size(pads(44.0, Some(47.0))), HeldSize::Ball(47.0));
            assert_eq!(own.size(pads(5.0, None)), HeldSize::Pads(5.0));
        }
    }

    #[test]
    fn a_block_of_nearly_the_same_size_is_the_same_one_again() {
        let (small, large) = (block(10.0, 24.0), block(50.0, 64.0));
        for (more, left) in [
            (block(12.0, 26.0), [block(12.0, 26.0), large]),
            (block(45.0, 60.0), [small, block(45.0, 60.0)]),
            (block(80.0, 95.0), [small, block(80.0, 95.0)]),
        ] {
            assert_eq!(measured(&[large, small, more]).blocks(), left);
        }
        let one = measured(&[small, block(12.0, 26.0)]);
        assert_eq!(one.blocks(), [block(12.0, 26.0)]);
        let near = measured(&[block(10.0, 24.0), block(21.0, 35.0), block(15.0, 30.0)]);
        assert_eq!(near.blocks(), [block(15.0, 30.0)], "near to both");
    }

    #[test]
    fn blocks_that_cannot_be_true_are_refused_and_change_nothing() {
        let kept = measured(&[block(10.0, 30.0)]);
        for (wrong, words) in [
            (block(50.0, 30.0), "do not match"),
            (block(50.0, 20.0), "do not match"),
            (block(50.0, 145.0), "do not match"),
            (block(50.0, f32::NAN), "do not match"),
            (block(f32::NAN, 50.0), "1 to 120 mm"),
            (block(0.5, 3.0), "1 to 120 mm"),
        ] {
            let mut all = kept.clone();
            let error = all.measure(wrong).unwrap_err().to_string();
            assert!(error.contains(words), "{wrong:?}: {error}");
            assert_eq!(all, kept);
        }
    }

    #[test]
    fn what_is_kept_comes_back_without_what_cannot_be_true() {
        let own = measured(&[block(10.0, 24.0), block(50.0, 66.0)]);
        let text = serde_json::to_string(&own).unwrap();
        assert_eq!(serde_json::from_str::<SizeBlocks>(&text).unwrap(), own);
        let bad = text.replace("66.0", "25.0");
        let left = serde_json::from_str::<SizeBlocks>(&bad).unwrap();
        assert_eq!(left.blocks(), [block(10.0, 24.0)]);
    }
}
