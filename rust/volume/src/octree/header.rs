//! The lines with which OctoMap's files begin.

use std::ops::RangeInclusive;

use super::OctreeError;

/// Sides of a voxel, m: finer ones than any robot sees make maps that take for ever, coarser ones say nothing.
const RESOLUTIONS_M: RangeInclusive<f64> = 0.001..=10.0;

/// Which of OctoMap's two formats a file has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// `.bt`: whether leaves are free or occupied.
    Binary,
    /// `.ot`: the log-odds of all nodes.
    Full,
}

impl Format {
    /// How a file of the format begins.
    const fn magic(self) -> &'static str {
        match self {
            Self::Binary => "# Octomap OcTree binary file",
            Self::Full => "# Octomap OcTree file",
        }
    }
}

/// What a tree keeps of each node beside what OctoMap's plain one does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TreeKind {
    /// Nothing.
    Plain,
    /// A colour, three bytes in the file, which is passed over.
    Colour,
}

impl TreeKind {
    const ALL: [Self; 2] = [Self::Plain, Self::Colour];

    /// What OctoMap calls it.
    const fn id(self) -> &'static str {
        match self {
            Self::Plain => "OcTree",
            Self::Colour => "ColorOcTree",
        }
    }
}

/// What the header says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Header {
    pub(super) format: Format,
    pub(super) kind: TreeKind,
    pub(super) nodes: usize,
    pub(super) resolution_m: f64,
    /// Where the nodes begin.
    pub(super) end: usize,
}

/// The header as OctoMap writes it.
pub(super) fn text(format: Format, nodes: usize, resolution_m: f64) -> String {
    format!(
        "{}\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid OcTree\nsize {nodes}\nres {resolution_m}\ndata\n",
        format.magic()
    )
}

/// Reads the header of a file whose name is only for errors.
pub(super) fn parse(name: &str, bytes: &[u8]) -> Result<Header, OctreeError> {
    let bad = |at: usize, reason: String| OctreeError::Format {
        path: name.to_owned(),
        at,
        reason,
    };
    let mut fields = Fields {
        format: format_of(bytes).map_err(|reason| bad(0, reason))?,
        kind: None,
        nodes: None,
        resolution_m: None,
    };
    let mut at = 0;
    loop {
        let rest = bytes.get(at..).unwrap_or_default();
        let Some(length) = rest.iter().position(|&byte| byte == b'\n') else {
            return Err(bad(at, "the header ends without \"data\"".to_owned()));
        };
        let line = String::from_utf8_lossy(&rest[..length]);
        if line.trim() == "data" {
            let end = at + length + 1;
            let header = fields.header(end);
            return header
                .ok_or_else(|| bad(at, "the header must say id, size and res".to_owned()));
        }
        fields.read(line.trim()).map_err(|reason| bad(at, reason))?;
        at += length + 1;
    }
}

fn format_of(bytes: &[u8]) -> Result<Format, String> {
    let formats = [Format::Binary, Format::Full];
    let found = formats
        .into_iter()
        .find(|format| bytes.starts_with(format.magic().as_bytes()));
    found.ok_or_else(|| {
        let [binary, full] = formats.map(Format::magic);
        format!("an octree begins with \"{binary}\" or \"{full}\"")
    })
}

/// What has been read of a header.
struct Fields {
    format: Format,
    kind: Option<TreeKind>,
    nodes: Option<usize>,
    resolution_m: Option<f64>,
}

impl Fields {
    fn read(&mut self, line: &str) -> Result<(), String> {
        if line.is_empty() || line.starts_with('#') {
            return Ok(());
        }
        let (key, value) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let wrong = |allowed: &str| format!("{key} must be {allowed}, got \"{value}\"");
        match key {
            "id" => {
                let kind = TreeKind::ALL.into_iter().find(|kind| kind.id() == value);
                self.kind = Some(kind.ok_or_else(|| wrong("OcTree or ColorOcTree"))?);
            }
            "size" => {
                let nodes = value.parse().map_err(|_| wrong("a number of nodes"))?;
                self.nodes = Some(nodes);
            }
            "res" => {
                let metres = value.parse::<f64>().ok();
                let usable = metres.filter(|m| RESOLUTIONS_M.contains(m));
                let allowed = || {
                    wrong(&format!(
                        "{} to {}",
                        RESOLUTIONS_M.start(),
                        RESOLUTIONS_M.end()
                    ))
                };
                self.resolution_m = Some(usable.ok_or_else(allowed)?);
            }
            _ => {
                let known = "id, size, res and data are";
                return Err(format!("\"{key}\" is no line of a header: {known}"));
            }
        }
        Ok(())
    }

    fn header(&self, end: usize) -> Option<Header> {
        Some(Header {
            format: self.format,
            kind: self.kind?,
            nodes: self.nodes?,
            resolution_m: self.resolution_m?,
            end,
        })
    }
}
