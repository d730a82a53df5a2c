//! The 58-byte block of one capacitive fingertip (manual 2.6.21). Decoding only; no view, no filter.

/// Bytes of one fingertip block.
pub const BLOCK_LEN: usize = 58;
/// Number of leading bytes that the check word covers.
const CHECKED_LEN: usize = 54;

/// Largest force that a fingertip may report, N: five times the sensor's rating (manual 1.1).
///
/// Manual: 2.6.21 gives no range.
pub const TIP_FORCE_MAX_N: f32 = 100.0;
/// The word for "no direction".
pub const NO_DIRECTION: u16 = 65535;

/// Centres of the seven pads in mm, x to the right, y towards the tip (protocol 5.2: pad i is channel i - 1).
// Manual: 2.6.21 gives no layout; this is the sensor maker's model.
pub const PAD_CENTRES_MM: [(f64, f64); 7] = [
    (-4.6, 1.2),
    (0.0, 4.0),
    (4.5, 0.8),
    (0.0, -3.2),
    (-3.5, -9.1),
    (3.5, -9.1),
    (0.1, 9.1),
];

/// Rise of all channels together from which the place of a contact is known, counts.
const SPOT_COUNTS: f64 = 20_000.0;

/// Place of the contact in mm, from the channels and those of the free fingertip: the mean of the pad centres, each weighted by its
/// rise. `None` if the channels rose too little.
pub fn spot_mm(raw: &[u32; 8], free: &[u32; 8]) -> Option<(f64, f64)> {
    let rises = raw.iter().zip(free);
    let rises = rises.map(|(raw, free)| (f64::from(*raw) - f64::from(*free)).max(0.0));
    let (mut all, mut x, mut y) = (0.0, 0.0, 0.0);
    for (rise, pad) in rises.zip(PAD_CENTRES_MM) {
        (all, x, y) = (all + rise, x + rise * pad.0, y + rise * pad.1);
    }
    (all >= SPOT_COUNTS).then(|| (x / all, y / all))
}

/// One fingertip's block, decoded (manual 2.6.21, table).
///
/// Manual: the last bytes and the signs are not explained. Raw values are unsigned counts; the
/// deltas and the proximity are signed counts; forces are newtons; see each field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TactileBlock {
    /// Capacitance counts of the eight channels.
    pub raw: [u32; 8],
    /// Normal force in newtons as sent: may be NaN, infinite or absurd.
    pub normal_n: f32,
    /// Change of the normal capacitance, counts.
    pub normal_delta: i32,
    /// Tangential force in newtons as sent.
    pub tangential_n: f32,
    /// Change of the tangential capacitance, counts.
    pub tangential_delta: i32,
    /// Direction word as sent: 0..=359 degrees, 65535 = no contact.
    pub direction_raw: u16,
    /// Proximity change, counts, 0 to about 16 million.
    pub proximity: i32,
    /// The check word as sent, low byte first.
    pub check: u16,
    /// 16-bit sum of the first 54 bytes, to compare with [`Self::check`].
    pub sum: u16,
    /// The two reserved bytes.
    pub reserved: [u8; 2],
}

impl TactileBlock {
    /// Decodes a block of exactly 58 bytes in memory order; `None` for any other length.
    pub fn decode(bytes: &[u8]) -> Option<Self> {
        let bytes: &[u8; BLOCK_LEN] = bytes.try_into().ok()?;
        let mut at = ByteReader(bytes.as_slice());
        let mut raw = [0; 8];
        for channel in &mut raw {
            *channel = u32::from_le_bytes(at.read()?);
        }
        Some(Self {
            raw,
            normal_n: f32::from_le_bytes(at.read()?),
            normal_delta: i32::from_le_bytes(at.read()?),
            tangential_n: f32::from_le_bytes(at.read()?),
            tangential_delta: i32::from_le_bytes(at.read()?),
            direction_raw: u16::from_le_bytes(at.read()?),
            proximity: i32::from_le_bytes(at.read()?),
            check: u16::from_le_bytes(at.read()?),
            reserved: at.read()?,
            sum: sum16(bytes.get(..CHECKED_LEN)?),
        })
    }

    /// Encodes the block in memory order with a correct check word; for the simulated hand.
    pub fn encode(&self) -> [u8; BLOCK_LEN] {
        self.with_check(sum16)
    }

    /// Encodes the block in memory order exactly as it was sent, including a wrong check word.
    pub fn as_sent(&self) -> [u8; BLOCK_LEN] {
        self.with_check(|_| self.check)
    }

    fn with_check(&self, check: impl Fn(&[u8]) -> u16) -> [u8; BLOCK_LEN] {
        let mut bytes = arrayvec::ArrayVec::<u8, BLOCK_LEN>::new();
        // Whole slices: byte by byte is slow in tests, where the simulated hand encodes five blocks a millisecond.
        let put = |bytes: &mut arrayvec::ArrayVec<u8, BLOCK_LEN>, part: &[u8]| {
            let _fits = bytes.try_extend_from_slice(part);
        };
        for channel in self.raw {
            put(&mut bytes, &channel.to_le_bytes());
        }
        put(&mut bytes, &self.normal_n.to_le_bytes());
        put(&mut bytes, &self.normal_delta.to_le_bytes());
        put(&mut bytes, &self.tangential_n.to_le_bytes());
        put(&mut bytes, &self.tangential_delta.to_le_bytes());
        put(&mut bytes, &self.direction_raw.to_le_bytes());
        put(&mut bytes, &self.proximity.to_le_bytes());
        let check = check(&bytes);
        put(&mut bytes, &check.to_le_bytes());
        put(&mut bytes, &self.reserved);
        bytes.into_inner().unwrap_or([0; BLOCK_LEN])
    }

    /// Direction of the tangential force in degrees, 0 towards the tip; `None` without contact
    /// and for words that are not an angle.
    pub fn direction_deg(&self) -> Option<u16> {
        (self.direction_raw < 360).then_some(self.direction_raw)
    }

    /// Normal force, N; `None` if it is not a number up to [`TIP_FORCE_MAX_N`]. Only this may feed logic.
    pub fn normal(&self) -> Option<f32> {
        documented(self.normal_n)
    }

    /// Tangential force, N; `None` if it is not a number up to [`TIP_FORCE_MAX_N`]. Only this may feed logic.
    pub fn tangential(&self) -> Option<f32> {
        documented(self.tangential_n)
    }

    /// True if the check word equals the 16-bit sum of the first 54 bytes. Shown only; data is never dropped for it.
    pub const fn check_ok(&self) -> bool {
        self.check == self.sum
    }
}

fn documented(newtons: f32) -> Option<f32> {
    (newtons.abs() <= TIP_FORCE_MAX_N).then_some(newtons)
}

fn sum16(bytes: &[u8]) -> u16 {
    bytes
        .iter()
        .fold(0, |sum, byte| sum.wrapping_add(u16::from(*byte)))
}

/// Reads fixed-size pieces from the front of a slice.
struct ByteReader<'a>(&'a [u8]);

impl ByteReader<'_> {
    fn read<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*head)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn fields_stand_where_the_manuals_table_puts_them() {
        let mut bytes = [0u8; BLOCK_LEN];
        for (i, byte) in bytes.iter_mut().enumerate() {
            *byte = u8::try_from(i).unwrap();
        }
        bytes[32..36].copy_from_slice(&1.5f32.to_le_bytes());
        bytes[40..44].copy_from_slice(&(-0.25f32).to_le_bytes());
        let block = TactileBlock::decode(&bytes).unwrap();
        assert_eq!(block.raw[0], 0x0302_0100);
        assert_eq!(block.raw[7], 0x1F1E_1D1C);
        assert_eq!((block.normal_n, block.tangential_n), (1.5, -0.25));
        assert_eq!(block.normal_delta, 0x2726_2524);
        assert_eq!(block.tangential_delta, 0x2F2E_2D2C);
        assert_eq!(block.direction_raw, 0x3130);
        assert_eq!(block.proximity, 0x3534_3332);
        assert_eq!(block.check, 0x3736);
        assert_eq!(block.reserved, [56, 57]);
    }

    #[test]
    fn direction_65535_means_no_contact() {
        let mut bytes = [0u8; BLOCK_LEN];
        bytes[48..50].copy_from_slice(&[0xFF, 0xFF]);
        let block = TactileBlock::decode(&bytes).unwrap();
        assert_eq!(block.direction_deg(), None);
        assert!(!block.check_ok());
    }

    #[test]
    fn a_force_that_no_sensor_can_report_is_no_value() {
        let block = |newtons| TactileBlock {
            normal_n: newtons,
            tangential_n: newtons,
            ..TactileBlock::decode(&[0; BLOCK_LEN]).unwrap()
        };
        for (newtons, wanted) in [
            (0.0, Some(0.0)),
            (-0.4, Some(-0.4)),
            (100.0, Some(100.0)),
            (100.5, None),
            (f32::MAX, None),
            (f32::NEG_INFINITY, None),
            (f32::NAN, None),
        ] {
            let block = block(newtons);
            assert_eq!((block.normal(), block.tangential()), (wanted, wanted));
        }
    }

    #[test]
    fn other_lengths_are_refused() {
        for len in (0..BLOCK_LEN).chain(BLOCK_LEN + 1..200) {
            assert_eq!(TactileBlock::decode(&vec![0; len]), None);
        }
    }

    proptest! {
        #[test]
        fn any_bytes_decode_and_encode_to_themselves(bytes in prop::collection::vec(any::<u8>(), BLOCK_LEN)) {
            let block = TactileBlock::decode(&bytes).unwrap();
            let back = block.encode();
            prop_assert_eq!(&back[..CHECKED_LEN], &bytes[..CHECKED_LEN]);
            prop_assert_eq!(&back[56..], &bytes[56..]);
            prop_assert!(TactileBlock::decode(&back).unwrap().check_ok());
            prop_assert!(block.normal().is_none_or(f32::is_finite));
        }
    }
}
