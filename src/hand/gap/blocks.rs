//! Two blocks of known size correct what the model makes of the gap: size = scale x gap + offset.

use crate::hand::gap::path::PinchGap;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Two blocks differ by so much, in mm: of nearer ones the scale would be a guess. A block that is nearer to a known one is that
/// one, measured again.
const APART_MM: f32 = 10.0;
/// Scales and offsets beyond these, in mm, are no correction but a mistake: a wrong size was told, or something else was held.
const SCALES: RangeInclusive<f32> = 0.6..=1.6;
const OFFSET_MM: f32 = 30.0;

/// A block that was held: its size, and the gap that the model made of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// Its true size, mm.
    pub size_mm: f32,
    /// The distance of the pads by the model while it was held, mm.
    pub gap_mm: f32,
}

impl Block {
    /// Sizes that a block may have, mm.
    pub const SIZES_MM: RangeInclusive<f32> = 1.0..=120.0;
}

/// The size of what is held, mm, and of which shape it is true.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeldSize {
    /// Of an object like the two blocks that were measured with this hand.
    Block(f32),
    /// Diameter of a ball, by the model.
    Ball(f32),
    /// Of no shape: the pads are so far apart, by the model, and their edges may be what touches.
    Pads(f32),
}

/// The blocks that were measured with one hand, two at most, the smaller first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "Vec<Block>")]
pub struct SizeBlocks(Vec<Block>);

/// Why a block was not taken.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum BlockError {
    /// No block has such a size.
    #[error(
        "a block has {} to {} mm, not {size_mm}",
        Block::SIZES_MM.start(),
        Block::SIZES_MM.end()
    )]
    Size {
        /// What was told, mm.
        size_mm: f32,
    },
    /// With the other one it says what cannot be true.
    #[error(
        "the two blocks do not fit what the hand told (scale {scale:.2}, offset {offset_mm:.0} mm): measure both again, between thumb and index only"
    )]
    Unlikely {
        /// Scale that they would give.
        scale: f32,
        /// Offset, mm.
        offset_mm: f32,
    },
}

/// Size of a gap by two blocks.
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
    /// What was measured.
    pub fn blocks(&self) -> &[Block] {
        &self.0
    }

    /// True if none was measured.
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Takes a block; one of nearly its size is replaced, or of two the one that is nearer in size.
    ///
    /// # Errors
    /// [`BlockError`]: then nothing changed.
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
        // Of a pair whose other block is as near too, only the new one stays.
        let other = other.filter(|own| away(own) >= APART_MM);
        let mut blocks: Vec<Block> = other.into_iter().chain([block]).collect();
        blocks.sort_by(|one, two| one.size_mm.total_cmp(&two.size_mm));
        if let [one, two] = blocks.as_slice() {
            Correction::of(*one, *two)?;
        }
        self.0 = blocks;
        Ok(())
    }

    /// The size of what is held at this gap; by the model alone until two blocks were measured. Never less than nothing.
    pub fn size(&self, gap: PinchGap) -> HeldSize {
        let correction = match self.0.as_slice() {
            [one, two] => Correction::of(*one, *two).ok(),
            _ => None,
        };
        let block = correction.map(|own| own.scale * gap.mm + own.offset_mm);
        match (block, gap.ball_mm) {
            (Some(mm), _) => HeldSize::Block(mm.max(0.0)),
            (None, Some(mm)) => HeldSize::Ball(mm),
            (None, None) => HeldSize::Pads(gap.mm),
        }
    }
}

impl From<Vec<Block>> for SizeBlocks {
    fn from(kept: Vec<Block>) -> Self {
        let mut all = Self::default();
        for block in kept {
            // What a file says and no hand can have told is dropped.
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
            let told = own.size(pads(gap, None));
            assert!(
                matches!(told, HeldSize::Block(mm) if (mm - size).abs() < 0.01),
                "{told:?}"
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
            (block(50.0, 30.0), "do not fit"),
            (block(50.0, 20.0), "do not fit"),
            (block(50.0, 145.0), "do not fit"),
            (block(50.0, f32::NAN), "do not fit"),
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
