//! Scenes as PNG: areas and lines by tiny-skia, letters as the outlines of their glyphs.

use super::words::{INDEX_DROP, INDEX_SIZE, runs};
use super::{Colour, Item, Point, Scene, Segment, Stroke, Words, font};
use tiny_skia::{
    FillRule, LineCap, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, Stroke as Line, StrokeDash, Transform,
};

impl Scene {
    /// The scene as a PNG, `scale` pixels per unit.
    ///
    /// Time and memory are proportional to the number of pixels.
    ///
    /// # Errors
    /// A message where the picture is empty or larger than memory, and that of the encoder.
    pub fn png(&self, scale: f32) -> Result<Vec<u8>, String> {
        let pixels = |length: f64| (length * f64::from(scale)).round().clamp(0.0, 65_535.0) as u32;
        let (width, height) = (pixels(self.width), pixels(self.height));
        let mut map = Pixmap::new(width, height).ok_or("the picture is empty or too large")?;
        map.fill(tiny_skia::Color::WHITE);
        let mut painter = Painter { map, mask: None };
        painter.items(&self.items, Transform::from_scale(scale, scale));
        encoded(&painter.map)
    }
}

struct Painter {
    map: Pixmap,
    /// What is seen; all if `None`.
    mask: Option<Mask>,
}

impl Painter {
    fn items(&mut self, items: &[Item], transform: Transform) {
        for item in items {
            match item {
                Item::Path { segments, fill, stroke } => {
                    self.path(path(segments).as_ref(), *fill, stroke.as_ref(), transform);
                }
                Item::Circle { centre, radius, fill, stroke } => {
                    let circle = PathBuilder::from_circle(centre.0 as f32, centre.1 as f32, *radius as f32);
                    self.path(circle.as_ref(), *fill, stroke.as_ref(), transform);
                }
                Item::Words(words) => self.words(words, transform),
                Item::Sign { items, .. } | Item::Legend { items, .. } => self.items(items, transform),
                Item::Group { offset, clip, items } => {
                    let transform = transform.pre_translate(offset.0 as f32, offset.1 as f32);
                    let outer = self.mask.clone();
                    if let Some(outline) = clip.and_then(|clip| path(&clip.outline())) {
                        match &mut self.mask {
                            Some(mask) => mask.intersect_path(&outline, FillRule::Winding, true, transform),
                            None => {
                                let mut mask = Mask::new(self.map.width(), self.map.height());
                                if let Some(mask) = &mut mask {
                                    mask.fill_path(&outline, FillRule::Winding, true, transform);
                                }
                                self.mask = mask;
                            }
                        }
                    }
                    self.items(items, transform);
                    self.mask = outer;
                }
            }
        }
    }

    fn path(&mut self, path: Option<&Path>, fill: Option<Colour>, stroke: Option<&Stroke>, transform: Transform) {
        let Some(path) = path else { return };
        if let Some(colour) = fill {
            self.map.fill_path(path, &paint(colour), FillRule::Winding, transform, self.mask.as_ref());
        }
        if let Some(stroke) = stroke {
            let mut dashes: Vec<f32> = stroke.dashes.iter().map(|d| *d as f32).collect();
            if dashes.len() % 2 == 1 {
                dashes.extend(dashes.clone());
            }
            let line = Line {
                width: stroke.width as f32,
                line_join: LineJoin::Round,
                line_cap: LineCap::Butt,
                dash: StrokeDash::new(dashes, 0.0),
                ..Line::default()
            };
            self.map.stroke_path(path, &paint(stroke.colour), &line, transform, self.mask.as_ref());
        }
    }

    fn words(&mut self, words: &Words, transform: Transform) {
        let (x, y) = words.at;
        let transform = if words.turned { transform.pre_concat(turned(words.at)) } else { transform };
        let mut at = (x - words.before(), y);
        let mut letters = Vec::new();
        for run in runs(&words.text) {
            let (size, drop) =
                if run.lowered { (INDEX_SIZE * words.size, INDEX_DROP * words.size) } else { (words.size, 0.0) };
            letters.extend(font::outlines(run.text, size, (at.0, at.1 + drop)));
            at.0 += font::advance(run.text, size);
        }
        let letters = path(&letters);
        if let Some(halo) = words.halo {
            self.path(letters.as_ref(), None, Some(&Stroke::new(halo, 3.0)), transform);
        }
        self.path(letters.as_ref(), Some(words.colour), None, transform);
    }
}

/// A quarter of a turn to the left about a place.
fn turned((x, y): Point) -> Transform {
    let (x, y) = (x as f32, y as f32);
    Transform::from_row(0.0, -1.0, 1.0, 0.0, x - y, y + x)
}

fn paint(colour: Colour) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(colour.0, colour.1, colour.2, 255);
    paint
}

/// `None` where there is nothing, or a number is not finite.
fn path(segments: &[Segment]) -> Option<Path> {
    let mut builder = PathBuilder::new();
    let f = |p: &Point| (p.0 as f32, p.1 as f32);
    for segment in segments {
        match segment {
            Segment::Move(p) => builder.move_to(f(p).0, f(p).1),
            Segment::Line(p) => builder.line_to(f(p).0, f(p).1),
            Segment::Cubic(a, b, p) => builder.cubic_to(f(a).0, f(a).1, f(b).0, f(b).1, f(p).0, f(p).1),
            Segment::Close => builder.close(),
        }
    }
    builder.finish()
}

/// The file: red, green and blue of the pixels, of which none is transparent.
fn encoded(map: &Pixmap) -> Result<Vec<u8>, String> {
    let width = 3 * map.width() as usize;
    let colours: Vec<u8> = map.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut filtered = Vec::with_capacity(colours.len() + map.height() as usize);
    let nothing = vec![0; width];
    let mut above = nothing.as_slice();
    for row in colours.chunks_exact(width) {
        filtered.extend(smallest_filter(row, above));
        above = row;
    }
    let mut header = Vec::new();
    header.extend(map.width().to_be_bytes());
    header.extend(map.height().to_be_bytes());
    // Eight bits of red, green and blue, rows from above in one pass.
    header.extend([8, 2, 0, 0, 0]);
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    for (kind, data) in
        [(b"IHDR", header), (b"IDAT", miniz_oxide::deflate::compress_to_vec_zlib(&filtered, 6)), (b"IEND", Vec::new())]
    {
        let length = u32::try_from(data.len()).map_err(|_| "the picture is too large")?;
        bytes.extend(length.to_be_bytes());
        let begin = bytes.len();
        bytes.extend(kind);
        bytes.extend(data);
        bytes.extend(check_sum(&bytes[begin..]).to_be_bytes());
    }
    Ok(bytes)
}

/// A row as it is, or its differences to the pixels on the left or above: whichever is smallest in sum.
fn smallest_filter(row: &[u8], above: &[u8]) -> Vec<u8> {
    let left = std::iter::repeat_n(&0, 3).chain(row);
    let difference = |(a, b): (&u8, &u8)| a.wrapping_sub(*b);
    let filters: [Vec<u8>; 3] =
        [row.to_vec(), row.iter().zip(left).map(difference).collect(), row.iter().zip(above).map(difference).collect()];
    let size = |bytes: &[u8]| bytes.iter().map(|b| u64::from((*b as i8).unsigned_abs())).sum::<u64>();
    let best = (0..3).min_by_key(|k| size(&filters[*k])).unwrap_or(0);
    std::iter::once(best as u8).chain(filters[best].iter().copied()).collect()
}

/// The cyclic redundancy check of PNG (ISO/IEC 15948, annex D).
fn check_sum(bytes: &[u8]) -> u32 {
    let step = |sum: u32, _| if sum & 1 == 1 { 0xedb8_8320 ^ (sum >> 1) } else { sum >> 1 };
    let table: [u32; 256] = std::array::from_fn(|k| (0..8).fold(k as u32, step));
    !bytes.iter().fold(!0, |sum: u32, b| table[((sum ^ u32::from(*b)) & 255) as usize] ^ (sum >> 8))
}

#[cfg(test)]
mod tests {
    use super::super::{Anchor, Rectangle};
    use super::*;

    #[test]
    fn a_quarter_turn_keeps_its_place_and_sends_what_was_right_up() {
        let mut points = [tiny_skia::Point::from_xy(3.0, 4.0), tiny_skia::Point::from_xy(5.0, 4.0)];
        turned((3.0, 4.0)).map_points(&mut points);
        assert_eq!([(points[0].x, points[0].y), (points[1].x, points[1].y)], [(3.0, 4.0), (3.0, 2.0)]);
    }

    #[test]
    fn a_picture_without_area_and_one_beyond_all_numbers_do_not_panic() {
        assert!(Scene::new(0.0, 5.0).png(1.0).is_err());
        let mut scene = Scene::new(20.0, 20.0);
        scene.polyline(&[(0.0, f64::NAN), (f64::INFINITY, 3.0)], Stroke::new(Colour::BLACK, 1.0));
        scene.words(Words::new("", (1.0, 1.0), 9.0, Colour::BLACK).anchored(Anchor::End).turned());
        scene.clipped(Rectangle { left: 5.0, top: 5.0, width: 0.0, height: 0.0 }, |s| {
            s.circle((5.0, 5.0), 3.0, Some(Colour::BLACK), None);
        });
        assert!(scene.png(2.0).unwrap().starts_with(b"\x89PNG"));
    }

    #[test]
    fn another_decoder_reads_the_pixels_that_were_painted() {
        let mut scene = Scene::new(30.0, 20.0);
        scene.rectangle(
            &Rectangle { left: 5.0, top: 5.0, width: 10.0, height: 10.0 },
            Some(Colour(200, 100, 50)),
            None,
        );
        scene.words(Words::new("K_pwm", (1.0, 15.0), 8.0, Colour::BLACK));
        let bytes = scene.png(2.0).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((frame.width, frame.height, frame.color_type), (60, 40, png::ColorType::Rgb));
        let at = |x: usize, y: usize| &pixels[3 * (60 * y + x)..][..3];
        assert_eq!([at(0, 0), at(28, 12)], [&[255, 255, 255][..], &[200, 100, 50]]);
        assert_eq!(check_sum(b"123456789"), 0xcbf4_3926);
    }
}
