// From the export's space - right-handed, Y up, metres - to Unreal's - left-handed, Z up, centimetres - and back.
//
// Y and Z change places, as Unreal's own glTF importer has them, so that bones written here fit a mesh imported from the
// export's GLB. Exchanging two axes mirrors space, which turns rotations round: the axis is exchanged, the angle changes sign.
// What looks along +Z in the export looks along +Y in Unreal.
#pragma once

#include "CoreMinimal.h"

namespace MetagraphSpace
{
	constexpr double Centimetres = 100.0; // in a metre

	/** Unreal's centimetres of the export's metres. */
	inline FVector ToUnreal(double X, double Y, double Z)
	{
		return FVector(X * Centimetres, Z * Centimetres, Y * Centimetres);
	}

	/** Unreal's rotation of the export's, xyzw. */
	inline FQuat ToUnreal(double X, double Y, double Z, double W)
	{
		return FQuat(-X, -Z, -Y, W);
	}

	/** The export's metres of Unreal's centimetres, in the same axes' order as ToUnreal. */
	inline FVector FromUnreal(const FVector& Place)
	{
		return FVector(Place.X / Centimetres, Place.Z / Centimetres, Place.Y / Centimetres);
	}

	/** The export's rotation of Unreal's; its X, Y, Z, W are the export's. */
	inline FQuat FromUnreal(const FQuat& Turn)
	{
		return FQuat(-Turn.X, -Turn.Z, -Turn.Y, Turn.W);
	}
}
