//! A minimal PNG writer (ISO/IEC 15948): 8-bit RGB, one image chunk, deterministic bytes.

use flate2::{Compress, Compression, Crc, FlushCompress};

/// `pixels` row by row from the top, 3 bytes each, `width`·`height` of them.
pub(super) fn encode(pixels: &[u8], width: u32, height: u32) -> Vec<u8> {
    let row = width as usize * 3;
    let mut raw = Vec::with_capacity(pixels.len() + height as usize);
    for (k, line) in pixels.chunks(row.max(1)).enumerate() {
        // Filter "up" where a row repeats the one above, which most rows of a plot do; else none.
        let above = if k > 0 { &pixels[(k - 1) * row..k * row] } else { &[] };
        if above == line {
            raw.push(2);
            raw.resize(raw.len() + row, 0);
        } else {
            raw.push(0);
            raw.extend_from_slice(line);
        }
    }
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    header.extend([8, 2, 0, 0, 0]); // bits, RGB, deflate, adaptive filter, not interlaced
    chunk(&mut file, b"IHDR", &header);
    chunk(&mut file, b"IDAT", &deflate(&raw));
    chunk(&mut file, b"IEND", &[]);
    file
}

/// zlib stream of `raw`.
fn deflate(raw: &[u8]) -> Vec<u8> {
    let mut compressor = Compress::new(Compression::new(6), true);
    let mut packed = Vec::with_capacity(raw.len() / 16 + 1024);
    loop {
        let done = usize::try_from(compressor.total_in()).unwrap_or(usize::MAX).min(raw.len());
        let status = compressor.compress_vec(&raw[done..], &mut packed, FlushCompress::Finish);
        if !matches!(status, Ok(flate2::Status::Ok | flate2::Status::BufError)) {
            return packed;
        }
        packed.reserve(packed.capacity().max(1024));
    }
}

fn chunk(file: &mut Vec<u8>, name: &[u8; 4], data: &[u8]) {
    let mut crc = Crc::new();
    crc.update(name);
    crc.update(data);
    file.extend((data.len() as u32).to_be_bytes());
    file.extend(name);
    file.extend(data);
    file.extend(crc.sum().to_be_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    /// Reads back what `encode` writes: size and pixels.
    fn decode(file: &[u8]) -> (u32, u32, Vec<u8>) {
        let number = |k: usize| u32::from_be_bytes(file[k..k + 4].try_into().expect("4 bytes"));
        let (width, height) = (number(16), number(20));
        let length = number(33) as usize;
        assert_eq!(&file[37..41], b"IDAT");
        let mut raw = Vec::new();
        flate2::read::ZlibDecoder::new(&file[41..41 + length]).read_to_end(&mut raw).expect("zlib");
        let row = width as usize * 3;
        let mut pixels: Vec<u8> = Vec::new();
        for line in raw.chunks(row + 1) {
            let above: Vec<u8> = if line[0] == 2 { pixels[pixels.len() - row..].to_vec() } else { vec![0; row] };
            pixels.extend(line[1..].iter().zip(above).map(|(a, b)| a.wrapping_add(b)));
        }
        (width, height, pixels)
    }

    #[test]
    fn pixels_survive() {
        let pixels: Vec<u8> = (0..7 * 50 * 3).map(|k| if k < 300 { 255 } else { (k * k % 251) as u8 }).collect();
        assert_eq!(decode(&encode(&pixels, 7, 50)), (7, 50, pixels));
    }

    #[test]
    fn noise_that_does_not_compress_survives() {
        let mut state = 1u32;
        let mut noise = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        let pixels: Vec<u8> = (0..200 * 100 * 3).map(|_| noise()).collect();
        assert_eq!(decode(&encode(&pixels, 200, 100)).2, pixels);
    }
}
