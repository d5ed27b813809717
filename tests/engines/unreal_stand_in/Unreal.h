// Stand-ins for the types of Unreal that the plugin uses: names and signatures, with as much behaviour as its tests need.
// Unreal's texts are no char, so these are not either.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#define PI (3.1415926535897932f) // Unreal's is a macro, which the core must survive
#define check(expression)
#define verify(expression)
#define THIRD_PARTY_INCLUDES_START
#define THIRD_PARTY_INCLUDES_END
#define UCLASS(...)
#define USTRUCT(...)
#define UPROPERTY(...)
#define UFUNCTION(...)
#define GENERATED_BODY() \
public: \
    static UClass* StaticClass() { \
        static UClass one; \
        return &one; \
    }
#define METAGRAPH_API
#define METAGRAPHEDITOR_API
#define INDEX_NONE (-1)

using int32 = std::int32_t;
using uint8 = std::uint8_t;
using TCHAR = char16_t;
#define TEXT(words) u##words

// --- texts

inline std::u16string Widened(const std::string& text) {
    std::u16string out;
    for (std::size_t n = 0; n < text.size();) {
        const unsigned char first = static_cast<unsigned char>(text[n++]);
        std::uint32_t code = first < 0x80 ? first : first < 0xE0 ? first & 0x1F : first < 0xF0 ? first & 0x0F : first & 0x07;
        while (n < text.size() && (static_cast<unsigned char>(text[n]) & 0xC0) == 0x80) code = code << 6 | (text[n++] & 0x3F);
        if (code >= 0x10000) {
            out += static_cast<char16_t>(0xD800 + ((code - 0x10000) >> 10));
            out += static_cast<char16_t>(0xDC00 + ((code - 0x10000) & 0x3FF));
        } else {
            out += static_cast<char16_t>(code);
        }
    }
    return out;
}
inline std::string Narrowed(const std::u16string& text) {
    std::string out;
    for (std::size_t n = 0; n < text.size(); n++) {
        std::uint32_t code = text[n];
        if (code >= 0xD800 && code < 0xDC00 && n + 1 < text.size()) code = 0x10000 + ((code - 0xD800) << 10) + (text[++n] - 0xDC00);
        const int more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
        static const int lead[] = {0, 0xC0, 0xE0, 0xF0};
        out += static_cast<char>(lead[more] | code >> (6 * more));
        for (int k = more - 1; k >= 0; k--) out += static_cast<char>(0x80 | (code >> (6 * k) & 0x3F));
    }
    return out;
}

class FString {
public:
    FString() = default;
    FString(const TCHAR* text) : text_(text) {}
    const TCHAR* operator*() const { return text_.c_str(); }
    bool Contains(const TCHAR* part) const { return text_.find(part) != std::u16string::npos; }
    bool operator==(const FString& other) const { return text_ == other.text_; }
    bool IsEmpty() const { return text_.empty(); }

private:
    std::u16string text_;
};

class FTCHARToUTF8 {
public:
    explicit FTCHARToUTF8(const TCHAR* text) : text_(Narrowed(text)) {}
    const char* Get() const { return text_.c_str(); }
    int32 Length() const { return static_cast<int32>(text_.size()); }

private:
    std::string text_;
};
#define UTF8_TO_TCHAR(text) Widened(text).c_str()

class FName {
public:
    FName() = default;
    explicit FName(const TCHAR* text) : text_(text) {}
    bool operator==(const FName& other) const { return text_ == other.text_; }
    bool operator<(const FName& other) const { return text_ < other.text_; }

private:
    std::u16string text_;
};

class FText {
public:
    FString text;
};
#define LOCTEXT(key, words) FText{FString(u##words)}

struct ELogVerbosity {
    enum Type { Error, Warning };
};
#define UE_LOG(category, verbosity, format, ...) std::fprintf(stderr, "%s\n", FTCHARToUTF8(__VA_ARGS__).Get())

// --- containers and pointers

template <class T>
class TArray {
public:
    TArray() = default;
    TArray(std::vector<T> items) : items_(std::move(items)) {}
    void Add(const T& item) { items_.push_back(item); }
    void Reset() { items_.clear(); }
    int32 Num() const { return static_cast<int32>(items_.size()); }
    T* GetData() { return items_.data(); }
    const T* GetData() const { return items_.data(); }
    T& operator[](int32 place) { return items_.at(static_cast<std::size_t>(place)); }
    const T& operator[](int32 place) const { return items_.at(static_cast<std::size_t>(place)); }
    auto begin() const { return items_.begin(); }
    auto end() const { return items_.end(); }

private:
    std::vector<T> items_;
};

template <class K, class V>
class TMap {
public:
    void Add(const K& key, const V& value) { items_[key] = value; }
    void Reset() { items_.clear(); }
    int32 Num() const { return static_cast<int32>(items_.size()); }
    const V* Find(const K& key) const {
        auto found = items_.find(key);
        return found == items_.end() ? nullptr : &found->second;
    }

private:
    std::map<K, V> items_;
};

enum class ESPMode { NotThreadSafe, ThreadSafe };

template <class T, ESPMode Mode = ESPMode::ThreadSafe>
class TSharedRef : public std::shared_ptr<T> {
public:
    explicit TSharedRef(std::shared_ptr<T> of) : std::shared_ptr<T>(std::move(of)) {}
};

template <class T, ESPMode Mode = ESPMode::ThreadSafe>
class TSharedPtr {
public:
    TSharedPtr() = default;
    TSharedPtr(std::nullptr_t) {}
    template <class Other>
    TSharedPtr(const TSharedRef<Other, Mode>& of) : of_(of) {}
    bool IsValid() const { return of_ != nullptr; }
    void Reset() { of_.reset(); }
    T* operator->() const { return of_.get(); }
    T& operator*() const { return *of_; }

private:
    std::shared_ptr<T> of_;
};

template <class T, ESPMode Mode = ESPMode::ThreadSafe, class... Given>
TSharedRef<T, Mode> MakeShared(Given&&... given) {
    return TSharedRef<T, Mode>(std::make_shared<T>(std::forward<Given>(given)...));
}

template <class T>
class TObjectPtr {
public:
    TObjectPtr(T* of = nullptr) : of_(of) {}
    T* operator->() const { return of_; }
    explicit operator bool() const { return of_ != nullptr; }
    bool operator!() const { return of_ == nullptr; }

private:
    T* of_;
};

// --- geometry

struct FVector {
    double X = 0, Y = 0, Z = 0;

    FVector() = default;
    FVector(double x, double y, double z) : X(x), Y(y), Z(z) {}
    FVector operator+(const FVector& b) const { return {X + b.X, Y + b.Y, Z + b.Z}; }
    FVector operator-(const FVector& b) const { return {X - b.X, Y - b.Y, Z - b.Z}; }
    FVector operator*(double k) const { return {X * k, Y * k, Z * k}; }
};

struct FQuat {
    double X = 0, Y = 0, Z = 0, W = 1;

    FQuat() = default;
    FQuat(double x, double y, double z, double w) : X(x), Y(y), Z(z), W(w) {}
    FQuat Inverse() const { return {-X, -Y, -Z, W}; }
    FQuat operator*(const FQuat& b) const {
        return {W * b.X + X * b.W + Y * b.Z - Z * b.Y, W * b.Y - X * b.Z + Y * b.W + Z * b.X, W * b.Z + X * b.Y - Y * b.X + Z * b.W,
                W * b.W - X * b.X - Y * b.Y - Z * b.Z};
    }
    FVector RotateVector(const FVector& v) const {
        const FQuat q = *this * FQuat(v.X, v.Y, v.Z, 0) * Inverse();
        return {q.X, q.Y, q.Z};
    }
};

struct FTransform {
    FQuat Turn;
    FVector Place, Scale{1, 1, 1};

    FTransform() = default;
    FTransform(const FQuat& turn, const FVector& place) : Turn(turn), Place(place) {}
    FQuat GetRotation() const { return Turn; }
    FVector GetLocation() const { return Place; }
    FVector GetScale3D() const { return Scale; }
    void SetScale3D(const FVector& scale) { Scale = scale; }
    FVector InverseTransformPosition(const FVector& at) const { return Turn.Inverse().RotateVector(at - Place); }
    void BlendWith(const FTransform& other, float alpha) {
        const double same = Turn.X * other.Turn.X + Turn.Y * other.Turn.Y + Turn.Z * other.Turn.Z + Turn.W * other.Turn.W;
        const double b = same < 0 ? -alpha : alpha, a = 1 - alpha;
        FQuat q(Turn.X * a + other.Turn.X * b, Turn.Y * a + other.Turn.Y * b, Turn.Z * a + other.Turn.Z * b, Turn.W * a + other.Turn.W * b);
        const double k = 1 / std::sqrt(q.X * q.X + q.Y * q.Y + q.Z * q.Z + q.W * q.W);
        Turn = FQuat(q.X * k, q.Y * k, q.Z * k, q.W * k);
        Place = Place * a + other.Place * alpha;
    }
};

// --- objects

class UClass {};
enum EObjectFlags { RF_NoFlags };

class UObject {
public:
    virtual ~UObject() = default;
};
class UDataAsset : public UObject {};

template <class T>
T* NewObject(UObject*, UClass*, FName, EObjectFlags) {
    return new T();
}

enum ETickingGroup { TG_PrePhysics };
enum ELevelTick { LEVELTICK_All };
struct FActorComponentTickFunction {
    bool bCanEverTick = false;
    ETickingGroup TickGroup = TG_PrePhysics;
};

class AActor;
class UActorComponent : public UObject {
public:
    FActorComponentTickFunction PrimaryComponentTick;
    AActor* Owner = nullptr;

    AActor* GetOwner() const { return Owner; }
    virtual void BeginPlay() {}
    virtual void TickComponent(float, ELevelTick, FActorComponentTickFunction*) {}
    virtual UClass* GetClass() const { return nullptr; }
};

class USkeletalMeshComponent : public UActorComponent {
public:
    GENERATED_BODY()
    std::map<FName, float> Morphs;
    UActorComponent* Before = nullptr;
    FTransform Transform;

    UClass* Class = nullptr;
    UClass* GetAnimClass() const { return Class; }
    void SetAnimInstanceClass(UClass* given) { Class = given; }
    void SetMorphTarget(FName name, float value, bool) { Morphs[name] = value; }
    void AddTickPrerequisiteComponent(UActorComponent* component) { Before = component; }
    const FTransform& GetComponentTransform() const { return Transform; }
    UClass* GetClass() const override { return StaticClass(); }
};

class AActor : public UObject {
public:
    std::vector<UActorComponent*> Components;

    template <class T>
    T* FindComponentByClass() const {
        for (UActorComponent* one : Components) {
            if (one->GetClass() == T::StaticClass()) return static_cast<T*>(one);
        }
        return nullptr;
    }
};

#define DECLARE_DYNAMIC_MULTICAST_DELEGATE_ThreeParams(Name, A, a, B, b, C, c) \
    struct Name { \
        std::vector<std::function<void(A, B, C)>> Listeners; \
        void Broadcast(A first, B second, C third) { \
            for (const auto& one : Listeners) one(first, second, third); \
        } \
    }

// --- animation

class FMeshPoseBoneIndex {
public:
    explicit FMeshPoseBoneIndex(int32 place) : place_(place) {}
    int32 GetInt() const { return place_; }

private:
    int32 place_;
};
class FCompactPoseBoneIndex {
public:
    explicit FCompactPoseBoneIndex(int32 place) : place_(place) {}
    int32 GetInt() const { return place_; }

private:
    int32 place_;
};

/// Bones of a mesh; those a level of detail leaves out have no place in the compact pose.
struct FBoneContainer {
    std::vector<FName> Bones;
    std::vector<int32> Compact;

    int32 GetPoseBoneIndexForBoneName(const FName& name) const {
        for (std::size_t n = 0; n < Bones.size(); n++) {
            if (Bones[n] == name) return static_cast<int32>(n);
        }
        return INDEX_NONE;
    }
    FCompactPoseBoneIndex MakeCompactPoseIndex(const FMeshPoseBoneIndex& place) const {
        return FCompactPoseBoneIndex(Compact.at(static_cast<std::size_t>(place.GetInt())));
    }
};

struct FCompactPose {
    FBoneContainer Container;
    std::vector<FTransform> Transforms;

    const FBoneContainer& GetBoneContainer() const { return Container; }
    FTransform& operator[](const FCompactPoseBoneIndex& place) { return Transforms.at(static_cast<std::size_t>(place.GetInt())); }
};

class UAnimInstance;
struct FPoseContext;
struct FAnimInstanceProxy {
    FBoneContainer Required;
    FAnimInstanceProxy() = default;
    explicit FAnimInstanceProxy(UAnimInstance*) {}
    virtual ~FAnimInstanceProxy() = default;
    const FBoneContainer& GetRequiredBones() const { return Required; }
    virtual void PreUpdate(UAnimInstance*, float) {}
    virtual void CacheBones() {}
    virtual bool Evaluate(FPoseContext&) { return false; }
};
namespace UE { namespace Anim {
enum class ECurveElementFlags { None = 0, MorphTarget = 1 };
} }
struct FBlendedCurve {
    std::map<FName, float> Values;
    std::map<FName, UE::Anim::ECurveElementFlags> Flags;
    void SetFlags(const FName& name, UE::Anim::ECurveElementFlags flags) { Flags[name] = flags; }
    void Set(const FName& name, float value) { Values[name] = value; }
    float Get(const FName& name) const { return Values.count(name) ? Values.at(name) : 0.0f; }
};
struct FAnimationBaseContext {
    FAnimInstanceProxy* AnimInstanceProxy = nullptr;
};
struct FAnimationInitializeContext : FAnimationBaseContext {};
struct FAnimationCacheBonesContext : FAnimationBaseContext {};
struct FAnimationUpdateContext : FAnimationBaseContext {};
struct FPoseContext : FAnimationBaseContext {
    FCompactPose Pose;
    FBlendedCurve Curve;
    void ResetToRefPose() {
        for (FTransform& one : Pose.Transforms) one = FTransform();
    }
};
struct FNodeDebugData {
    FString GetNodeName(const void*) const { return FString(); }
    void AddDebugItem(FString) {}
};
struct FPoseLink {
    void Initialize(const FAnimationInitializeContext&) {}
    void CacheBones(const FAnimationCacheBonesContext&) {}
    void Update(const FAnimationUpdateContext&) {}
    void Evaluate(FPoseContext&) {}
    void GatherDebugData(FNodeDebugData&) {}
};
struct FExposedValueHandler {
    void Execute(const FAnimationBaseContext&) const {}
};

class UAnimInstance : public UObject {
public:
    AActor* Actor = nullptr;
    AActor* GetOwningActor() const { return Actor; }

protected:
    virtual FAnimInstanceProxy* CreateAnimInstanceProxy() { return nullptr; }
};

struct FAnimNode_Base {
    virtual ~FAnimNode_Base() = default;
    virtual void Initialize_AnyThread(const FAnimationInitializeContext&) {}
    virtual void CacheBones_AnyThread(const FAnimationCacheBonesContext&) {}
    virtual void Update_AnyThread(const FAnimationUpdateContext&) {}
    virtual void Evaluate_AnyThread(FPoseContext&) {}
    virtual void GatherDebugData(FNodeDebugData&) {}
    virtual bool HasPreUpdate() const { return false; }
    virtual void PreUpdate(const UAnimInstance*) {}
    const FExposedValueHandler& GetEvaluateGraphExposedInputs() const {
        static const FExposedValueHandler none;
        return none;
    }
};

// --- the editor

struct ENodeTitleType {
    enum Type { FullTitle };
};
class UAnimGraphNode_Base : public UObject {
public:
    virtual FText GetNodeTitle(ENodeTitleType::Type) const { return {}; }
    virtual FText GetTooltipText() const { return {}; }
    virtual FString GetNodeCategory() const { return {}; }
};

class FFeedbackContext {
public:
    std::string Said;
    void Logf(ELogVerbosity::Type, const TCHAR* format, const TCHAR* word) { Said += Narrowed(format) + " " + Narrowed(word) + "\n"; }
};

class UFactory : public UObject {
public:
    UClass* SupportedClass = nullptr;
    bool bCreateNew = true, bEditorImport = false;
    int32 ImportPriority = 100;
    TArray<FString> Formats;
    static constexpr int32 DefaultImportPriority = 100;

    virtual bool FactoryCanImport(const FString&) { return false; }
    virtual UObject* FactoryCreateFile(
        UClass*, UObject*, FName, EObjectFlags, const FString&, const TCHAR*, FFeedbackContext*, bool&
    ) {
        return nullptr;
    }
};

struct FFileHelper {
    static bool LoadFileToArray(TArray<uint8>& out, const TCHAR* path) {
        std::ifstream in(Narrowed(path), std::ios::binary);
        if (!in) return false;
        out = TArray<uint8>(std::vector<uint8>(std::istreambuf_iterator<char>(in), {}));
        return true;
    }
    static bool LoadFileToString(FString& out, const TCHAR* path) {
        std::ifstream in(Narrowed(path), std::ios::binary);
        if (!in) return false;
        out = FString(Widened(std::string(std::istreambuf_iterator<char>(in), {})).c_str());
        return true;
    }
};
struct FPaths {
    static FString GetExtension(const FString& path) { return FString(std::u16string(*path).substr(Dot(path) + 1).c_str()); }
    static FString ChangeExtension(const FString& path, const TCHAR* to) {
        return FString((std::u16string(*path).substr(0, Dot(path) + 1) + to).c_str());
    }
    static FString GetCleanFilename(const FString& path) {
        const std::u16string all(*path);
        return FString(all.substr(all.rfind(u'/') + 1).c_str());
    }

private:
    static std::size_t Dot(const FString& path) { return std::u16string(*path).rfind(u'.'); }
};

class FDefaultModuleImpl {};
#define IMPLEMENT_MODULE(Implementation, Name) static_assert(sizeof(Implementation) > 0);
