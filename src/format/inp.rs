//! Abaqus / CalculiX input decks (.inp): nodes and node sets.
//!
//! Read: `*NODE` (NSET=, INPUT=, SYSTEM=R/C/S), `*NSET` (GENERATE, labels, names of earlier sets) and
//! `*INCLUDE`, relative to the file that includes. Keywords and names in any case; set names are
//! kept in capitals. Everything else is passed over, also `*NSET, ELSET=`. Cards that make or move
//! nodes by themselves are refused, since passing them over would give wrong positions.

use super::error::{Fault, FormatError, quote};
use super::input::{read_all, sha256};
use super::number::whole_real;
use crate::model::{NodeId, Source};
use nom::Parser;
use nom::branch::alt;
use nom::bytes::complete::{take_till, take_while1};
use nom::character::complete::{char, space0};
use nom::combinator::{all_consuming, opt};
use nom::multi::many0;
use nom::sequence::{delimited, preceded};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Nodes and named node sets of a finite-element mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Position of each node, in the file's unit of length.
    pub nodes: BTreeMap<NodeId, [f64; 3]>,
    /// Node sets by name in capitals, labels ascending.
    pub node_sets: BTreeMap<String, Vec<NodeId>>,
}

/// Files that may be included in total, so that a file cannot include itself to death in a roundabout way.
const MOST_FILES: usize = 1000;
/// Cards that change nodes in ways not read here.
const REFUSED: [&str; 5] = ["NGEN", "NFILL", "NCOPY", "NMAP", "SYSTEM"];

/// True for a deck: its first line that is no comment is a keyword.
pub(super) fn looks_like(head: &[u8]) -> bool {
    let mut lines = head.split(|&b| b == b'\n').map(<[u8]>::trim_ascii).filter(|l| !l.is_empty());
    lines.find(|l| !l.starts_with(b"**")).is_some_and(|l| l.len() > 2 && l[0] == b'*' && l[1].is_ascii_alphabetic())
}

/// Reads nodes and node sets. The hash is that of the file and, one after the other in the order of
/// their first use, of the files it includes.
pub fn read_mesh(path: &Path) -> Result<(Mesh, Source), FormatError> {
    let mut deck = Deck::default();
    let mut hashes = Vec::new();
    deck.file(path, &mut Vec::new(), &mut hashes)?;
    let (nodes, sets) = (&deck.nodes, &deck.sets);
    if nodes.is_empty() {
        return Err(Fault::new("no *NODE card")
            .expected("an Abaqus or CalculiX mesh")
            .cure("name the .inp file that holds the nodes")
            .in_file(path));
    }
    let mut node_sets = BTreeMap::new();
    for (name, items) in sets {
        let members = resolve(name, items, nodes, &deck.files)?;
        node_sets.insert(name.clone(), members.into_iter().collect());
    }
    let sha256 = if hashes.len() == 1 { hashes.remove(0) } else { sha256(hashes.concat().as_bytes()) };
    let source = Source { role: "mesh".into(), path: path.display().to_string(), sha256 };
    Ok((Mesh { nodes: nodes.iter().map(|(&id, node)| (id, node.position)).collect(), node_sets }, source))
}

/// Where something was said: index of the file, line.
type Spot = (usize, usize);

/// A run of labels in a set; one label is a run with `first == last`.
type Run = (u32, u32, u32);

struct Node {
    position: [f64; 3],
    spot: Spot,
}

#[derive(Default)]
struct Deck {
    files: Vec<PathBuf>,
    nodes: BTreeMap<NodeId, Node>,
    sets: BTreeMap<String, BTreeMap<Run, Spot>>,
}

/// What the data lines under the current keyword mean.
enum Section {
    Other,
    Nodes { set: Option<String>, system: u8 },
    Set { name: String, generate: bool },
}

impl Deck {
    fn file(&mut self, path: &Path, open: &mut Vec<PathBuf>, hashes: &mut Vec<String>) -> Result<(), FormatError> {
        let (text, hash) = read_all(path)?;
        hashes.push(hash);
        let index = self.enter(path);
        open.push(same_file(path));
        let mut section = Section::Other;
        let mut lines = text.split(|&b| b == b'\n').enumerate().map(|(k, line)| (k + 1, line.trim_ascii()));
        while let Some((number, line)) = lines.next() {
            let fail = |fault: Fault| fault.in_file(path);
            if line.is_empty() || line.starts_with(b"**") {
                continue;
            }
            if line[0] != b'*' {
                self.data(&section, line, (index, number)).map_err(fail)?;
                continue;
            }
            let mut card = String::from_utf8_lossy(line).into_owned();
            while card.ends_with(',') {
                match lines.next() {
                    Some((_, more)) if more.starts_with(b"**") => {}
                    Some((_, more)) => card += &String::from_utf8_lossy(more),
                    None => break,
                }
            }
            let card = Card::parse(&card, number).map_err(fail)?;
            section = self.keyword(&card, number).map_err(fail)?;
            let included = match (card.keyword.as_str(), &section) {
                ("INCLUDE", _) => Some(card.value("INPUT").ok_or_else(|| {
                    fail(Fault::line(number, "*INCLUDE without a file").expected("*INCLUDE, INPUT=file"))
                })?),
                (_, Section::Nodes { .. }) => card.value("INPUT"),
                _ => None,
            };
            if let Some(name) = included {
                let other = path.parent().unwrap_or(Path::new("")).join(name.trim_matches('"'));
                if open.contains(&same_file(&other)) || self.files.len() >= MOST_FILES {
                    let found = format!("{} is included again", other.display());
                    return Err(fail(Fault::line(number, found).expected("files that do not include each other")));
                }
                if card.keyword == "INCLUDE" {
                    self.file(&other, open, hashes)?;
                } else {
                    hashes.push(self.node_file(&other, &section)?);
                }
            }
        }
        open.pop();
        Ok(())
    }

    fn enter(&mut self, path: &Path) -> usize {
        self.files.push(path.to_path_buf());
        self.files.len() - 1
    }

    /// `*NODE, INPUT=file`: node lines without keywords.
    fn node_file(&mut self, path: &Path, section: &Section) -> Result<String, FormatError> {
        let (text, hash) = read_all(path)?;
        let index = self.enter(path);
        for (k, line) in text.split(|&b| b == b'\n').map(<[u8]>::trim_ascii).enumerate() {
            if !line.is_empty() && !line.starts_with(b"**") {
                self.data(section, line, (index, k + 1)).map_err(|fault| fault.in_file(path))?;
            }
        }
        Ok(hash)
    }

    fn keyword(&mut self, card: &Card, line: usize) -> Result<Section, Fault> {
        if REFUSED.contains(&card.keyword.as_str()) {
            return Err(Fault::line(line, format!("*{} makes or moves nodes", card.keyword))
                .expected("plain *NODE lines")
                .cure("let the program write the mesh out flat and use that file"));
        }
        Ok(match card.keyword.as_str() {
            "NODE" => {
                let system = match card.value("SYSTEM").map(str::to_ascii_uppercase).as_deref() {
                    None | Some("R") => b'R',
                    Some("C") => b'C',
                    Some("S") => b'S',
                    Some(other) => {
                        return Err(Fault::line(line, format!("SYSTEM={other}")).expected("R, C or S"));
                    }
                };
                Section::Nodes { set: card.value("NSET").map(set_name), system }
            }
            "NSET" if card.has("ELSET") => Section::Other,
            "NSET" => {
                let name = card
                    .value("NSET")
                    .map(set_name)
                    .filter(|n| !n.is_empty())
                    .ok_or_else(|| Fault::line(line, "*NSET without a name").expected("*NSET, NSET=name"))?;
                self.sets.entry(name.clone()).or_default();
                Section::Set { name, generate: card.has("GENERATE") }
            }
            _ => Section::Other,
        })
    }

    fn data(&mut self, section: &Section, line: &[u8], spot: Spot) -> Result<(), Fault> {
        match section {
            Section::Other => Ok(()),
            Section::Nodes { set, system } => self.node(line, set.as_deref(), *system, spot),
            Section::Set { name, generate } => self.members(line, name, *generate, spot),
        }
    }

    fn node(&mut self, line: &[u8], set: Option<&str>, system: u8, spot: Spot) -> Result<(), Fault> {
        let expected = "label, x, y, z";
        let wrong = || Fault::line(spot.1, format!("found {}", quote(line))).expected(expected);
        let mut fields = line.split(|&b| b == b',').map(<[u8]>::trim_ascii);
        let id = NodeId(fields.next().and_then(unsigned).filter(|&id| id > 0).ok_or_else(wrong)?);
        let mut raw = [0.0; 3];
        for (value, field) in raw.iter_mut().zip(fields.by_ref()) {
            // A missing coordinate is zero in both programs.
            if !field.is_empty() {
                *value = whole_real(field).ok_or_else(wrong)?;
            }
        }
        if !raw.iter().all(|v| v.is_finite()) {
            return Err(Fault::line(spot.1, format!("node {id} lies at {raw:?}")).expected("finite coordinates"));
        }
        let position = match system {
            b'C' => [raw[0] * raw[1].to_radians().cos(), raw[0] * raw[1].to_radians().sin(), raw[2]],
            b'S' => {
                let (turn, rise) = (raw[1].to_radians(), raw[2].to_radians());
                [raw[0] * rise.cos() * turn.cos(), raw[0] * rise.cos() * turn.sin(), raw[0] * rise.sin()]
            }
            _ => raw,
        };
        if let Some(set) = set {
            self.sets.entry(set.to_owned()).or_default().entry((id.0, id.0, 1)).or_insert(spot);
        }
        if let Some(old) = self.nodes.get(&id) {
            if old.position != position {
                let (file, line) = (&self.files[old.spot.0], old.spot.1);
                return Err(Fault::line(
                    spot.1,
                    format!("node {id} also stands at {}:{line}, elsewhere", file.display()),
                )
                .expected("each label once")
                .cure("parts and instances repeat labels: write the mesh out flat, with one label per node"));
            }
            return Ok(());
        }
        self.nodes.insert(id, Node { position, spot });
        Ok(())
    }

    fn members(&mut self, line: &[u8], name: &str, generate: bool, spot: Spot) -> Result<(), Fault> {
        let fields: Vec<&[u8]> = line.split(|&b| b == b',').map(<[u8]>::trim_ascii).filter(|f| !f.is_empty()).collect();
        let mut runs = Vec::new();
        if generate {
            let numbers: Option<Vec<u32>> = fields.iter().map(|f| unsigned(f)).collect();
            let run = match numbers.as_deref() {
                Some(&[first, last]) => Some((first, last, 1)),
                Some(&[first, last, step]) => Some((first, last, step)),
                _ => None,
            };
            let run = run
                .filter(|r| r.0 > 0 && r.1 >= r.0 && r.2 > 0)
                .ok_or_else(|| Fault::line(spot.1, format!("found {}", quote(line))).expected("first, last, step"))?;
            runs.push(run);
        } else {
            for field in fields {
                if let Some(label) = unsigned(field) {
                    runs.push((label, label, 1));
                    continue;
                }
                let other = set_name(&String::from_utf8_lossy(field));
                let known = self.sets.get(&other).filter(|_| other != name).ok_or_else(|| {
                    Fault::line(spot.1, format!("set {name} names {}", quote(field)))
                        .expected("a label or the name of an earlier node set")
                })?;
                runs.extend(known.keys());
            }
        }
        let set = self.sets.entry(name.to_owned()).or_default();
        for run in runs {
            set.entry(run).or_insert(spot);
        }
        Ok(())
    }
}

/// The labels of a set. A label that stands alone must be a node; of a GENERATE range those count
/// that are nodes, and there must be one.
fn resolve(
    name: &str,
    items: &BTreeMap<Run, Spot>,
    nodes: &BTreeMap<NodeId, Node>,
    files: &[PathBuf],
) -> Result<BTreeSet<NodeId>, FormatError> {
    let mut members = BTreeSet::new();
    for (&(first, last, step), &(file, line)) in items {
        let before = members.len();
        let in_run = nodes.range(NodeId(first)..=NodeId(last)).map(|(&id, _)| id);
        let mut any = false;
        members.extend(in_run.filter(|id| (id.0 - first) % step == 0).inspect(|_| any = true));
        if members.len() == before && !any {
            let found = if first == last {
                format!("set {name} holds node {first}, which no *NODE card defines")
            } else {
                format!("set {name} holds nodes {first} to {last}, none of which is defined")
            };
            return Err(Fault::line(line, found).expected("labels of nodes in the mesh").in_file(&files[file]));
        }
    }
    Ok(members)
}

fn set_name(raw: &str) -> String {
    raw.trim().trim_matches('"').to_ascii_uppercase()
}

fn unsigned(field: &[u8]) -> Option<u32> {
    std::str::from_utf8(field).ok()?.parse().ok()
}

fn same_file(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}

/// A keyword line: `*NSET, NSET=TIP, GENERATE`.
struct Card {
    keyword: String,
    parameters: Vec<(String, Option<String>)>,
}

impl Card {
    fn parse(text: &str, line: usize) -> Result<Self, Fault> {
        let word = || take_while1::<_, _, nom::error::Error<&str>>(|c| c != ',' && c != '=');
        let quoted = delimited(char('"'), take_till(|c| c == '"'), char('"'));
        let value = alt((quoted, take_till(|c| c == ',')));
        let parameter = (preceded((char(','), space0), word()), opt(preceded((char('='), space0), value)));
        let empty = preceded(
            (char(','), space0),
            nom::combinator::peek(alt((nom::bytes::complete::tag(","), nom::combinator::eof))),
        );
        let mut card = all_consuming((
            preceded(char('*'), word()),
            many0(alt((parameter.map(Some), empty.map(|_| None)))),
            space0,
        ));
        let (_, (keyword, parameters, _)) = card.parse(text).map_err(|_| {
            Fault::line(line, format!("found {}", quote(text.as_bytes()))).expected("*KEYWORD, PARAMETER=VALUE, …")
        })?;
        let tidy = |name: &str| name.trim().to_ascii_uppercase();
        let parameters = parameters
            .into_iter()
            .flatten()
            .map(|(name, value)| (tidy(name), value.map(|v: &str| v.trim().to_owned())))
            .collect();
        Ok(Self { keyword: tidy(keyword), parameters })
    }

    fn value(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find(|p| p.0 == name).and_then(|p| p.1.as_deref())
    }

    fn has(&self, name: &str) -> bool {
        self.parameters.iter().any(|p| p.0 == name)
    }
}
