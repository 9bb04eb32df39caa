"""Which attributes and child elements an element may have: one table, checked before anything is
read, so that a slip of the pen is an error with its place and not a value that is passed over."""

from __future__ import annotations

from typing import NamedTuple

from brdfc.source.diagnostics import did_you_mean
from brdfc.xml.document import Node


class Kind(NamedTuple):
    """What an element may have; attributes with ! must be there."""

    attributes: str = ""
    children: str | None = ""
    """None where the reader of the element knows better."""


_CHANNELS = "InputChannels! OutputChannels! Name Reserved Reserved2"
_FILE = "Filename File Format FileEncoding Endian"
_TEXT = "LanguageCountry!"
_SPECTRUM = "start! end! steps! Reserved reserved"
_ELEMENTS = (
    "CurveSetElement MatrixElement CLutElement ExtCLutElement CalculatorElement TintArrayElement "
    "XYZToJabElement JabToXYZElement UnknownElement"
)

SCHEMA: dict[str, Kind] = {
    # elements
    "MultiProcessElements": Kind(_CHANNELS, _ELEMENTS),
    "MatrixElement": Kind(_CHANNELS, "MatrixData ConstantData"),
    "MatrixData": Kind("InvertMatrix"),
    "ConstantData": Kind(),
    "CLutElement": Kind(_CHANNELS + " GridGranularity", "GridPoints TableData"),
    "ExtCLutElement": Kind(_CHANNELS + " GridGranularity StorageType", "GridPoints TableData"),
    "GridPoints": Kind(),
    "TableData": Kind(_FILE),
    "CurveSetElement": Kind(
        _CHANNELS, "SegmentedCurve SingleSampledCurve SampledCalculatorCurve DuplicateCurve"
    ),
    "DuplicateCurve": Kind("Index!"),
    "SegmentedCurve": Kind("", "FormulaSegment SampledSegment"),
    "FormulaSegment": Kind("Start! End! FunctionType! Reserved Reserved2"),
    "SampledSegment": Kind("Start! End! StorageType Reserved " + _FILE),
    "SingleSampledCurve": Kind(
        "FirstEntry! LastEntry! StorageType ExtensionType Start End " + _FILE
    ),
    "SampledCalculatorCurve": Kind(
        "FirstEntry! LastEntry! DesiredSize! ExtensionType Reserved2", "CalculatorElement"
    ),
    "TintArrayElement": Kind(_CHANNELS, None),
    "XYZToJabElement": Kind(_CHANNELS, "ColorAppearanceParams"),
    "JabToXYZElement": Kind(_CHANNELS, "ColorAppearanceParams"),
    "ColorAppearanceParams": Kind(
        "",
        "WhitePoint Luminance BackgroundLuminance ImpactSurround ChromaticInductionFactor "
        "AdaptationFactor",
    ),
    "WhitePoint": Kind("", "XYZNumber"),
    "UnknownElement": Kind(_CHANNELS + " Type type"),
    # calculators
    "CalculatorElement": Kind(
        _CHANNELS + " InputNames OutputNames", "Imports Variables Macros SubElements MainFunction"
    ),
    "IccCalcImport": Kind("", "Imports Variables Macros SubElements"),
    "Imports": Kind("", "Import"),
    "Import": Kind("Filename!"),
    "Variables": Kind("", "Declare"),
    "Declare": Kind("Name! Size Position"),
    "Macros": Kind("", "Macro"),
    "Macro": Kind("Name! Local"),
    "SubElements": Kind("", _ELEMENTS),
    "MainFunction": Kind(),
    # tag types
    "multiLocalizedUnicodeType": Kind("reserved", "TagSignature LocalizedText"),
    "LocalizedText": Kind(_TEXT),
    "UTF8TextArray": Kind("", "ArrayTags"),
    "TextData": Kind(),
    "dictType": Kind("reserved", "TagSignature DictEntry"),
    "DictEntry": Kind("Name! Value", "LocalizedName LocalizedValue"),
    "XYZNumber": Kind("X! Y! Z!"),
    "signatureType": Kind("reserved", "TagSignature Signature"),
    "Data": Kind("Flag " + _FILE),
    "Array": Kind(_FILE),
    "multiProcessElementType": Kind("reserved", "TagSignature MultiProcessElements"),
    "spectralViewingConditionsType": Kind(
        "reserved",
        "TagSignature StdObserver IlluminantXYZ ObserverFuncs StdIlluminant ColorTemperature "
        "IlluminantSPD SurroundXYZ",
    ),
    "IlluminantXYZ": Kind("X! Y! Z!"),
    "SurroundXYZ": Kind("X! Y! Z!"),
    "ObserverFuncs": Kind(_SPECTRUM),
    "IlluminantSPD": Kind(_SPECTRUM),
    "Curve": Kind("IdentitySize", ""),
    "ParametricCurve": Kind("FunctionType! Reserved", ""),
    "Unicode": Kind("LanguageCode", ""),
    "MacScript": Kind("ScriptCode", ""),
    "HexCompressedData": Kind("", ""),
    "DateTime": Kind("", ""),
    "cicpFields": Kind(
        "ColorPrimaries TransferCharacteristics MatrixCoefficients VideoFullRangeFlag", ""
    ),
    "ColorantOrder": Kind("", "n"),
    "PrivateType": Kind("type! reserved", "TagSignature UnknownData"),
    "UnknownData": Kind(),
    # header
    "IccProfile": Kind("", "Header Tags"),
    "Tags": Kind("", None),
    "Header": Kind(
        "",
        "PreferredCMMType ProfileVersion ProfileSubClassVersion ProfileDeviceClass "
        "ProfileDeviceSubClass DataColourSpace PCS CreationDateTime PrimaryPlatform ProfileFlags "
        "DeviceManufacturer DeviceModel DeviceAttributes RenderingIntent PCSIlluminant "
        "ProfileCreator ProfileID SpectralPCS SpectralRange BiSpectralRange MCS Reserved",
    ),
    "ProfileFlags": Kind(
        "EmbeddedInFile UseWithEmbeddedDataOnly ExtendedRangePCS MCSNeedsSubset VendorFlags"
    ),
    "DeviceAttributes": Kind(
        "ReflectiveOrTransparency GlossyOrMatte MediaPolarity MediaColour VendorSpecific"
    ),
    "PCSIlluminant": Kind("", "XYZNumber"),
    "SpectralRange": Kind("", "Wavelengths"),
    "BiSpectralRange": Kind("", "Wavelengths"),
    "Wavelengths": Kind("start! end! steps!"),
}


def check(root: Node) -> None:
    """Refuse what the table does not have; ProfileError shows the place."""
    waiting = [root]
    while waiting:
        node = waiting.pop()
        kind = SCHEMA.get(node.tag)
        if kind is not None:
            _attributes(node, kind)
            if kind.children is not None:
                _children(node, kind.children.split())
        waiting += reversed(node.children)


def _attributes(node: Node, kind: Kind) -> None:
    required = {name[:-1] for name in kind.attributes.split() if name.endswith("!")}
    allowed = {name.rstrip("!") for name in kind.attributes.split()}
    for name in node.attributes:
        if name not in allowed and ":" not in name and not name.startswith("xmlns"):
            node.fail(f"<{node.tag}> has no attribute '{name}'", _hint(name, allowed))
    for name in sorted(required - node.attributes.keys()):
        node.fail(f"<{node.tag}> needs the attribute '{name}'")


def _children(node: Node, allowed: list[str]) -> None:
    for child in node.children:
        if child.tag not in allowed:
            child.fail(f"<{child.tag}> cannot stand in <{node.tag}>", _hint(child.tag, allowed))


def _hint(name: str, allowed: list[str] | set[str]) -> str | None:
    listed = ", ".join(sorted(allowed)) or "nothing"
    return did_you_mean(name, allowed) or f"what can: {listed}"
