"""Content of a page as data URIs, so that it is one file."""

import base64
import io

from PIL import Image


def data_uri(kind: str, content: bytes) -> str:
    """Return content of a media type as a data URI."""
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"


def jpeg_uri(picture: Image.Image) -> str:
    """Return a picture as a data URI."""
    buffer = io.BytesIO()
    picture.convert("RGB").save(buffer, "JPEG", quality=85)
    return data_uri("image/jpeg", buffer.getvalue())
