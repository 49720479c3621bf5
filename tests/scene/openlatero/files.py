"""Files of OpenLatero's, written by hand."""


def scene(*patterns, operation='<operation type="max"/>'):
    """A scene of patterns."""
    inside = "\n".join(patterns)
    return (
        '<?xml version="1.0"?>\n<laterographics_xml type="Generator">\n'
        f'<Generator type="Canvas">\n<Pattern type="Group">\n{operation}\n{inside}\n'
        "</Pattern>\n</Generator>\n</laterographics_xml>\n"
    )


def texture(subtype, inside=""):
    return f'<Pattern type="Texture" subtype="{subtype}">\n{inside}\n</Pattern>'


def grating(ridge=4, gap=2, inside="", angle=None):
    turn = "" if angle is None else f'<angle units="degree">{angle}</angle>'
    return texture("LinearGrating", f"{turn}<seed>3.5,1.25</seed>{waves(ridge, gap)}{inside}")


def waves(ridge=4, gap=2, inside=""):
    return (
        f'<Grating><enable>yes</enable><ridge_size units="mm">{ridge}</ridge_size>'
        f'<gap_size units="mm">{gap}</gap_size>{inside}</Grating>'
    )


def swings(hertz=30, amplitude=0.7, mode="high", enable="yes"):
    return (
        f'<vibration><enable>{enable}</enable><frequency units="Hz">{hertz}</frequency>'
        f"<amplitude>{amplitude}</amplitude><blend_mode>{mode}</blend_mode></vibration>"
    )


def stroke(width=8, inside="", edge=1.5, ridge=""):
    return (
        f'<stroke><width units="mm">{width}</width><ridge><width units="mm">{width}</width>'
        f'<edge_width units="mm">{edge}</edge_width>{ridge}</ridge>{inside}</stroke>'
    )


def line(inside="", ends=("20,30", "60.5,42")):
    start, end = ends
    return (
        f'<Pattern type="Line"><start_point units="mm">{start}</start_point>'
        f'<end_point units="mm">{end}</end_point>{inside}</Pattern>'
    )


def circle(inside="", center="50,40", radius=18):
    return (
        f'<Pattern type="Circle"><center units="mm">{center}</center>'
        f'<radius units="mm">{radius}</radius>{inside}</Pattern>'
    )


def polygon(inside="", vertices=("20,20", "70,25", "55,60")):
    listed = "".join(f'<vertex units="mm">{vertex}</vertex>' for vertex in vertices)
    return f'<Pattern type="Polygon"><vertices>{listed}</vertices>{inside}</Pattern>'


def fill(pattern, gap=0, fade=1):
    return (
        f'<fill_texture><enable>yes</enable><gap units="mm">{gap}</gap>'
        f'<edge_size units="mm">{fade}</edge_size>{pattern}</fill_texture>'
    )
