"""The tags of versions 2, 4 and 5 as data: names, types, and what a transform connects."""

from __future__ import annotations

from typing import NamedTuple


class TagKind(NamedTuple):
    """A tag: its name, the types it may have from version 4 on, and what its transform connects.

    channels names the header's spaces that give the channel counts in and out: device (data
    colour space), pcs, spectral (spectral PCS), mcs, brdf (the four angles of the BRDF tags
    followed by device), any number written as itself, or None for tags that are no transform.
    D2B led to the PCS before there were spectral PCSs: "spectral or pcs". before_4: the types of
    version 2, and since_5 those from version 5 on, where they are others.
    """

    name: str
    types: tuple[str, ...]
    channels: tuple[str, str] | None = None
    before_4: tuple[str, ...] = ()
    since_5: tuple[str, ...] = ()

    def allowed(self, major_version: int) -> tuple[str, ...]:
        """The types that the tag may have in a version."""
        if major_version < 4:
            return self.before_4 or self.types
        return self.since_5 or self.types if major_version >= 5 else self.types


_MPET = ("mpet",)
_NUMBERS = ("fl16", "fl32", "fl64", "ui08", "ui16")
_TABLES = ("mft1", "mft2")
_CURVES = ("curv", "para")


def _description(name: str) -> TagKind:
    return TagKind(name, ("mluc",), before_4=("desc",))


def _from_pcs(name: str, outputs: str) -> TagKind:
    types = (*_TABLES, "mBA ")
    return TagKind(name, types, ("pcs", outputs), _TABLES, (*types, "mpet"))


TAGS: dict[str, TagKind] = {
    # Texts.
    "desc": _description("profileDescription"),
    "cprt": TagKind("copyright", ("mluc",), before_4=("text",)),
    "dmnd": _description("deviceMfgDesc"),
    "dmdd": _description("deviceModelDesc"),
    "vued": _description("viewingCondDesc"),
    "scrd": TagKind("screeningDesc", ("desc",)),
    "targ": TagKind("charTarget", ("text",), since_5=("utf8", "zut8")),
    "meta": TagKind("metadata", ("dict",)),
    "CxF ": TagKind("cxf", ("utf8", "zut8", "zxml", "ZXML"), since_5=("utf8", "zut8")),
    "csnm": TagKind("colorSpaceName", ("utf8",)),
    "rfnm": TagKind("referenceName", ("utf8",)),
    # Colours and curves.
    "wtpt": TagKind("mediaWhitePoint", ("XYZ ",)),
    "bkpt": TagKind("mediaBlackPoint", ("XYZ ",)),
    "lumi": TagKind("luminance", ("XYZ ",)),
    "rXYZ": TagKind("redMatrixColumn", ("XYZ ",)),
    "gXYZ": TagKind("greenMatrixColumn", ("XYZ ",)),
    "bXYZ": TagKind("blueMatrixColumn", ("XYZ ",)),
    "rTRC": TagKind("redTRC", _CURVES),
    "gTRC": TagKind("greenTRC", _CURVES),
    "bTRC": TagKind("blueTRC", _CURVES),
    "kTRC": TagKind("grayTRC", _CURVES),
    "chad": TagKind("chromaticAdaptation", ("sf32",)),
    "chrm": TagKind("chromaticity", ("chrm",)),
    "cicp": TagKind("cicp", ("cicp",)),
    # Colorants.
    "clro": TagKind("colorantOrder", ("clro",)),
    "cloo": TagKind("colorantOrderOut", ("clro",)),
    "clrt": TagKind("colorantTable", ("clrt",)),
    "clot": TagKind("colorantTableOut", ("clrt",)),
    "clin": TagKind("colorantInfo", ("tary",)),
    "clio": TagKind("colorantInfoOut", ("tary",)),
    "ncl2": TagKind("namedColor2", ("ncl2",), since_5=("ncl2", "tary")),
    "nmcl": TagKind("namedColor", ("tary",)),
    # Circumstances.
    "calt": TagKind("calibrationDateTime", ("dtim",)),
    "ciis": TagKind("colorimetricIntentImageState", ("sig ",)),
    "meas": TagKind("measurement", ("meas",)),
    "resp": TagKind("outputResponse", ("rcs2",)),
    "rig0": TagKind("perceptualRenderingIntentGamut", ("sig ",)),
    "rig2": TagKind("saturationRenderingIntentGamut", ("sig ",)),
    "tech": TagKind("technology", ("sig ",)),
    "view": TagKind("viewingConditions", ("view",)),
    "pseq": TagKind("profileSequenceDesc", ("pseq",)),
    "psid": TagKind("profileSequenceIdentifier", ("psid",)),
    # Spectra and multiplex channels.
    "A2M0": TagKind("AToM0", _MPET, ("device", "mcs")),
    "M2A0": TagKind("MToA0", _MPET, ("mcs", "device")),
    "mcta": TagKind("multiplexTypeArray", ("tary",)),
    "mdv ": TagKind("multiplexDefaultValues", ("ui08", "ui16", "fl16", "fl32")),
    "c2sp": TagKind("customToStandardPcc", _MPET, ("3", "3")),
    "s2cp": TagKind("standardToCustomPcc", _MPET, ("3", "3")),
    "svcn": TagKind("spectralViewingConditions", ("svcn",)),
    "swpt": TagKind("spectralWhitePoint", _NUMBERS),
    "sdin": TagKind("spectralDataInfo", ("sdin",)),
    "smap": TagKind("surfaceMap", ("ehim", "enim")),
    # Version 2's for PostScript; the reference looks at none of their types.
    "crdi": TagKind("crdInfo", ("crdi",)),
    "ps2s": TagKind("ps2CSA", ("data",)),
    "ps2i": TagKind("ps2RenderingIntent", ("data",)),
    "scrn": TagKind("screening", ("scrn",)),
    "bfd ": TagKind("ucrBg", ("bfd ",)),
    **{f"psd{n}": TagKind(f"ps2CRD{n}", ("data",)) for n in "0123"},
    "gamt": _from_pcs("gamut", "1"),
    **{f"pre{n}": _from_pcs(f"preview{n}", "pcs") for n in "012"},
}
for _n in "0123":
    TAGS |= {
        f"A2B{_n}": TagKind(
            f"AToB{_n}",
            (*_TABLES, "mAB "),
            ("device", "pcs"),
            before_4=_TABLES,
            since_5=(*_TABLES, "mAB ", "mpet", "tstr"),
        ),
        f"B2A{_n}": _from_pcs(f"BToA{_n}", "device"),
        f"D2B{_n}": TagKind(f"DToB{_n}", _MPET, ("device", "spectral or pcs")),
        f"B2D{_n}": TagKind(f"BToD{_n}", _MPET, ("spectral or pcs", "device")),
        f"M2B{_n}": TagKind(f"MToB{_n}", _MPET, ("mcs", "pcs")),
        f"M2S{_n}": TagKind(f"MToS{_n}", _MPET, ("mcs", "spectral")),
        f"bAB{_n}": TagKind(f"brdfAToB{_n}", _MPET, ("brdf", "pcs")),
        f"bDB{_n}": TagKind(f"brdfDToB{_n}", _MPET, ("brdf", "spectral")),
        f"bcp{_n}": TagKind(f"brdfColorimetricParameter{_n}", ("tstr",)),
        f"bsp{_n}": TagKind(f"brdfSpectralParameter{_n}", ("tstr",)),
        f"bMB{_n}": TagKind(f"brdfMToB{_n}", ("tstr",)),
        f"bMS{_n}": TagKind(f"brdfMToS{_n}", ("tstr",)),
        f"gbd{_n}": TagKind(f"gamutBoundaryDescription{_n}", ("gbd ",)),
        f"H2S{_n}": TagKind(f"HToS{_n}", _MPET),
    }
